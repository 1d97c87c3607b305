#include "engine/render_plan.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "engine/scene/scene_error.h"

namespace wavecrest {
namespace {

ColumnNeeds columnNeeds(const Scene& scene, Specialization specialization) {
  const uint32_t features = featuresOf(specialization);
  return {.shadingNormals = (features & kShadingNormals) != 0,
          .textures = (features & kTextures) != 0,
          .normalMaps = (features & sceneFeatures(scene) & kNormalMaps) != 0,
          .rouletteScale = (features & (kSpecularBsdfs | kBidirectional)) != 0,
          .connections = (features & kBidirectional) != 0,
          .bsdfOrder = (features & (kSpecularBsdfs | kLayeredBsdfs)) != 0};
}

bool isBidirectional(const RenderSettings& settings) {
  return isBidirectional(pageOf(settings.method, settings.metropolis.variant));
}

}  // namespace

Specialization specializationFor(const Scene& scene, const RenderSettings& settings) {
  const uint32_t features = sceneFeatures(scene) | (isBidirectional(settings) ? kBidirectional : 0u);
  const Specialization least = chooseSpecialization(features, settings.precision);
  if (!settings.specialization) return least;
  if ((features & ~featuresOf(*settings.specialization)) != 0) {
    throw std::runtime_error("scene and method need the '" +
                             std::string(kSpecializationNames[static_cast<size_t>(least)]) + "' kernels");
  }
  return chooseSpecialization(featuresOf(*settings.specialization), settings.precision);
}

template <class S>
Intersector<S> chooseIntersector(const Stages<S>& stages, Accel accel) {
  if (accel == Accel::small) return {stages.extendSmall, stages.occludeSmall, stages.lanes};
  if (accel == Accel::bvh) return {stages.extendBvh, stages.occludeBvh, stages.lanes};
  return {extendEmbree<S>, occludeEmbree<S>, kEmbreePacket};
}
template Intersector<float> chooseIntersector(const Stages<float>&, Accel);
template Intersector<double> chooseIntersector(const Stages<double>&, Accel);

template <class S>
RenderPlan<S> planRender(const Scene& scene, const RenderSettings& settings) {
  RenderPlan<S> plan;
  // Densities of path space are those of rays that leave one point.
  const bool inPathSpace =
      settings.method == Method::mlt && settings.metropolis.variant == MetropolisVariant::pathspace;
  if (inPathSpace && scene.sensor.kind != Sensor::Kind::perspective) {
    throw SceneError({scene.name}, "pathspace needs a pinhole; expected one, or --mlt mmlt");
  }
  plan.specialization = specializationFor(scene, settings);
  plan.needs = columnNeeds(scene, plan.specialization);
  plan.scene = compileScene<S>(scene, settings.accel, settings.precision != Precision::fast);
  const CameraView& camera = plan.scene->view.camera;
  const bool clipped = camera.nearClip > 0 || std::isfinite(camera.farClip);
  if (clipped && settings.method == Method::mlt && settings.metropolis.variant == MetropolisVariant::pathspace) {
    throw SceneError({scene.name},
                     "pathspace knows no clips of the camera, and the scene has a surface outside of them; "
                     "expected other clips, or another method");
  }
  const Stages<S>& stages = findStages<S>(settings.isa, settings.precision, plan.specialization);
  plan.isa = stages.isa;
  plan.stages = &stages;
  plan.pipeline = makePipeline(pageOf(settings.method, settings.metropolis.variant), stages,
                               chooseIntersector(stages, plan.accel()));
  plan.needs.splats = plan.pipeline.splats();
  plan.lightUse = {.connected = !plan.pipeline.photonMap || plan.pipeline.cameraPass.strategies.connect,
                   .merged = plan.pipeline.photonMap};
  if (plan.pipeline.chains && plan.pipeline.chains->inPathSpace) {
    const uint32_t least = settings.metropolis.directPass ? kDirectLength + 1 : 1;
    plan.pathLaws = PathLaws(least, std::max(settings.limits.maxDepth, least));
    plan.pathLaws.kinds = settings.metropolis.pathMutations;
  }
  return plan;
}
template RenderPlan<float> planRender(const Scene&, const RenderSettings&);
template RenderPlan<double> planRender(const Scene&, const RenderSettings&);

MisSettings misSettings(MisSettings strategies, const RenderSettings& settings, double sceneRadius, size_t count,
                        uint64_t iteration) {
  const auto lightPaths = static_cast<double>(count);
  strategies.lightPaths = lightPaths;
  strategies.camN = lightPaths;
  const double shrink = std::pow(static_cast<double>(iteration + 1), (settings.radiusAlpha - 1) / 2);
  strategies.radius = std::max(settings.radius * shrink, kSmallestRadius) * sceneRadius;
  const double density = std::numbers::pi * strategies.radius * strategies.radius * lightPaths;
  strategies.mergeNorm = 1 / density;
  strategies.kVM = strategies.merge ? density : 0;
  strategies.kVC = strategies.merge && strategies.connect ? 1 / density : 0;
  return strategies;
}

uint32_t pieceSize(size_t items, uint32_t threads, uint32_t most) {
  constexpr size_t kPiecesPerThread = 16, kLeast = 128;
  if (threads <= 1) return most;
  const size_t fair = (items + kPiecesPerThread * threads - 1) / (kPiecesPerThread * threads);
  const size_t whole = (fair + kColumnPadding - 1) / kColumnPadding * kColumnPadding;
  return static_cast<uint32_t>(std::min<size_t>(most, std::max(whole, kLeast)));
}

RenderSettings withPieces(const RenderSettings& settings, size_t pixels) {
  RenderSettings cut = settings;
  const MethodPage page = pageOf(settings.method, settings.metropolis.variant);
  // Camera walks alone take several iterations of a pixel at once: their waves stay, over fewer pixels.
  if (!page.hasChains() && page.walk(Walk::light) == nullptr) return cut;
  const size_t items = page.hasChains() ? std::max<size_t>(settings.metropolis.chains, 1) : pixels;
  cut.waveSize = pieceSize(items, settings.cutForThreads(), settings.waveSize);
  return cut;
}

FilmArea filmArea(const FilmSettings& film) {
  if (film.cropWidth == 0 || film.cropHeight == 0) return FilmArea::make(0, 0, film.width, film.height);
  return FilmArea::make(film.cropX, film.cropY, film.cropWidth, film.cropHeight);
}

}  // namespace wavecrest
