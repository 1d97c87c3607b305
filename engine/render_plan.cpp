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

// Whether kernels with the whole MIS recursion are needed.
bool isBidirectional(const RenderSettings& settings) {
  if (settings.method == Method::mlt) return settings.metropolis.variant != MetropolisVariant::pssmlt;
  return entryOf(settings.method).bidirectional;
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
  // A chain keeps no numbers for the place on the lens, or the pixel, that t = 1 chooses; and densities of path space
  // are those of rays that leave one point.
  if (settings.method == Method::mlt && isBidirectional(settings)) {
    const MetropolisVariant variant = settings.metropolis.variant;
    const bool lens = scene.sensor.kind == Sensor::Kind::thinlens || scene.film.filter != ReconstructionFilter::box;
    const bool parallel = scene.sensor.kind == Sensor::Kind::orthographic && variant == MetropolisVariant::pathspace;
    if (lens || parallel) {
      throw SceneError({scene.name}, std::string(kMetropolisVariantNames[static_cast<size_t>(variant)]) +
                                         " needs a pinhole and the box filter; expected those, or --mlt pssmlt");
    }
  }
  plan.specialization = specializationFor(scene, settings);
  plan.needs = columnNeeds(scene, plan.specialization);
  plan.scene = compileScene<S>(scene, settings.accel, settings.precision != Precision::fast);
  const Stages<S>& stages = findStages<S>(settings.isa, settings.precision, plan.specialization);
  plan.isa = stages.isa;
  plan.pipeline =
      makePipeline(settings.method, settings.metropolis.variant, stages, chooseIntersector(stages, plan.accel()));
  plan.lightUse = {.connected = !plan.pipeline.photonMap || plan.pipeline.cameraPass.strategies.connect,
                   .merged = plan.pipeline.photonMap};
  if (plan.pipeline.chains && plan.pipeline.chains->inPathSpace()) {
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
  // Below the precision of positions nothing could be merged.
  strategies.radius = std::max(settings.radius * shrink, 16 * 0x1p-24) * sceneRadius;
  const double density = std::numbers::pi * strategies.radius * strategies.radius * lightPaths;
  strategies.mergeNorm = 1 / density;
  strategies.kVM = strategies.merge ? density : 0;
  strategies.kVC = strategies.merge && strategies.connect ? 1 / density : 0;
  return strategies;
}

FilmArea filmArea(const FilmSettings& film) {
  if (film.cropWidth == 0 || film.cropHeight == 0) return FilmArea::make(0, 0, film.width, film.height);
  return FilmArea::make(film.cropX, film.cropY, film.cropWidth, film.cropHeight);
}

}  // namespace wavecrest
