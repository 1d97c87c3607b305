#include "engine/plan/render_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <string>

#include "engine/compile/materials.h"
#include "engine/film/spread_sums.h"
#include "engine/plan/share_iterations.h"
#include "engine/scene/scene_error.h"

namespace wavecrest {
namespace {

// The optional columns that kernels of this specialisation work on. Columns of normal maps and tangents are left out
// where the scene has none.
ColumnNeeds columnNeeds(const Scene& scene, Specialization specialization, bool keepsInstances) {
  const uint32_t features = featuresOf(specialization);
  return {.shadingNormals = (features & kShadingNormals) != 0,
          .textures = (features & kTextures) != 0,
          .normalMaps = (features & sceneFeatures(scene) & kNormalMaps) != 0,
          .tangents = (features & kCompoundBsdfs) != 0 && hasTangents(scene),
          .instances = keepsInstances,
          .rouletteScale = (features & (kSpecularBsdfs | kBidirectional)) != 0,
          .connections = (features & kBidirectional) != 0,
          .bsdfOrder = (features & (kSpecularBsdfs | kLayeredBsdfs)) != 0};
}

template <class S>
double largestCoordinate(const SceneView<S>& view) {
  double largest = 0;
  for (size_t axis = 0; axis < 3; ++axis) {
    largest = std::max(largest, std::abs(view.center[axis]) + view.halfExtent[axis]);
  }
  return largest;
}

// Mutations of path space keep the events of a path: reflection, refraction or passing, but not which part of a blend.
void refuseDeltaBlends(const Scene& scene) {
  for (const Shape& shape : scene.shapes) {
    if (shape.material == kNone) continue;
    const Material& material = scene.materials[shape.material];
    if (!std::holds_alternative<Blend>(material.kind)) continue;
    Material whole = material;
    whole.opacity.reset();
    const bool passes = shape.emitter == kNone && hasPassage(material, scene);
    if ((compileMaterial(whole, scene, passes).flags & kHasDelta) == 0) continue;
    throw SceneError(material.source,
                     "pathspace cannot tell the delta lobes of a blend apart; expected BSDFs without "
                     "them in it, or --mlt mmlt");
  }
}

// Along an edge paths of path space are seen or not: they keep no colour of what it passes.
void refuseTintedPassages(const Scene& scene) {
  for (const Shape& shape : scene.shapes) {
    if (shape.material == kNone || shape.emitter != kNone) continue;
    const Material& material = scene.materials[shape.material];
    if (!hasPassage(material, scene) || !tintsPassage(material, scene)) continue;
    throw SceneError(material.source,
                     "pathspace keeps no colour of light that goes straight on through a surface; expected surfaces "
                     "that do not tint it, or --mlt mmlt");
  }
}

MethodPage pageOf(const RenderSettings& settings) {
  // Without a guide nothing is learned, and the method is path tracing.
  if (settings.method == Method::gpt && settings.guide == GuideTarget::off) return pathTracing();
  MethodPage page = pageOf(settings.method, settings.metropolis.variant, settings.directPass);
  page.firstMerges = choosesMergeVertices(settings.method) && settings.mergeVertices == MergeVertices::first;
  return page;
}

bool isBidirectional(const RenderSettings& settings) { return isBidirectional(pageOf(settings)); }

}  // namespace

uint32_t featuresNeeded(const Scene& scene, const RenderSettings& settings) {
  const bool keeps = keepsInstances(scene, settings.accel, settings.instancing);
  return sceneFeatures(scene, keeps) | (isBidirectional(settings) ? kBidirectional : 0u);
}

Specialization specializationFor(const Scene& scene, const RenderSettings& settings) {
  const uint32_t features = featuresNeeded(scene, settings);
  // The first specialisation that covers what scene and method need.
  const Specialization least = chooseSpecialization(features, settings.precision);
  if (!settings.specialization) return least;
  // A choice of the settings must cover the same features.
  if ((features & ~featuresOf(*settings.specialization)) != 0) {
    throw SceneError({scene.name}, "scene and method need the '" +
                                       std::string(kSpecializationNames[static_cast<size_t>(least)]) + "' kernels");
  }
  // The choice may not be compiled for this precision. Then wider kernels are taken.
  return chooseSpecialization(featuresOf(*settings.specialization), settings.precision);
}

namespace {

template <class S>
Intersector<S> intersectorOf(const Stages<S>& stages, const CompiledScene<S>& scene) {
  if (scene.accel() == Accel::small) return {stages.extendSmall, stages.occludeSmall, stages.lanes};
  if (scene.view.instances != nullptr) return {stages.extendInstances, stages.occludeInstances, stages.lanes};
  if (scene.accel() == Accel::bvh) return {stages.extendBvh, stages.occludeBvh, stages.lanes};
  return {extendEmbree<S>, occludeEmbree<S>, kEmbreePacket};
}

}  // namespace

template <class S>
Intersector<S> chooseIntersector(const Stages<S>& stages, const CompiledScene<S>& scene) {
  const Intersector<S> intersector = intersectorOf(stages, scene);
  if (scene.view.passages == nullptr) return intersector;
  return {stages.extendPassing, stages.occludePassing, intersector.lanes};
}
template Intersector<float> chooseIntersector(const Stages<float>&, const CompiledScene<float>&);
template Intersector<double> chooseIntersector(const Stages<double>&, const CompiledScene<double>&);

namespace {

// Random numbers tell apart so many paths of an iteration. Throws SceneError where there are more.
void refuseTooManyPaths(const Scene& scene, const RenderSettings& settings) {
  const uint64_t pixels = uint64_t{settings.filmOf(scene).width} * settings.filmOf(scene).height;
  const uint64_t paths = std::max<uint64_t>(pixels, settings.lightPaths.value_or(0));
  if (paths <= kMostPaths) return;
  throw SceneError(
      {scene.name},
      fmt::format("an iteration has {} paths; expected at most {}, of pixels and of light paths", paths, kMostPaths));
}

}  // namespace

template <class S>
RenderPlan<S> planRender(const Scene& scene, const RenderSettings& settings,
                         std::shared_ptr<const CompiledScene<S>> compiled) {
  refuseTooManyPaths(scene, settings);
  RenderPlan<S> plan;
  // Densities of path space are those of rays that leave one point.
  const bool inPathSpace =
      settings.method == Method::mlt && settings.metropolis.variant == MetropolisVariant::pathspace;
  if (inPathSpace && scene.sensor.kind != Sensor::Kind::perspective) {
    throw SceneError({scene.name}, "pathspace needs a pinhole; expected one, or --mlt mmlt");
  }
  // Compile the scene for the kernels that it gets.
  plan.specialization = specializationFor(scene, settings);
  if (inPathSpace) {
    refuseDeltaBlends(scene);
    refuseTintedPassages(scene);
  }
  plan.scene = compiled ? std::move(compiled) : compileScene<S>(scene, settings.accel, true, settings.instancing);
  plan.view = plan.scene->view;
  if (settings.film) plan.view.camera = withFilm(plan.view.camera, scene.sensor, *settings.film, plan.scene->origin);
  plan.mergeRadius = {.first = settings.radius.value_or(kFixedRadius),
                      .alpha = settings.radiusAlpha,
                      .scene = plan.view.radius,
                      .least = kSmallestRadius * std::max(1.0, largestCoordinate(plan.view) / plan.view.radius)};
  plan.needs = columnNeeds(scene, plan.specialization, plan.view.instances != nullptr);
  plan.needs.passages = plan.view.passages != nullptr;
  plan.needs.visibility = plan.view.bvh != nullptr;
  // Clips are left in the compiled camera only where they hide a surface.
  const CameraView& camera = plan.view.camera;
  const bool clipped = camera.nearClip > 0 || std::isfinite(camera.farClip);
  if (clipped && settings.method == Method::mlt && settings.metropolis.variant == MetropolisVariant::pathspace) {
    throw SceneError({scene.name},
                     "pathspace knows no clips of the camera, and the scene has a surface outside of them; "
                     "expected other clips, or another method");
  }
  // Put the method's page together with the kernels.
  const Stages<S>& stages = findStages<S>(settings.isa, settings.precision, plan.specialization);
  plan.isa = stages.isa;
  plan.stages = &stages;
  if (plan.needs.passages) {
    const Intersector<S> intersector = intersectorOf(stages, *plan.scene);
    plan.view.closestHits = intersector.extend;
    plan.view.blockedRays = intersector.occlude;
  }
  plan.pipeline = makePipeline(pageOf(settings), stages, chooseIntersector(stages, *plan.scene));
  plan.needs.splats = plan.pipeline.splats();
  plan.needs.cells = !plan.pipeline.lessons.empty();
  plan.needs.directions = plan.pipeline.has(Fold::guide);
  // Without a photon map, light vertices are stored only to be connected.
  const bool merged = plan.pipeline.has(Fold::photonMap);
  plan.lightUse = {.connected = !merged || plan.pipeline.cameraPass().strategies.connect, .merged = merged};
  if (plan.pipeline.inPathSpace) {
    // Chains leave out the paths that the direct pass makes.
    const uint32_t least = settings.metropolis.directPass ? kDirectLength + 1 : 1;
    plan.pathLaws = PathLaws(least, std::max(settings.limits.maxDepth, least));
    plan.pathLaws.kinds = settings.metropolis.pathMutations;
  }
  return plan;
}
template RenderPlan<float> planRender(const Scene&, const RenderSettings&, std::shared_ptr<const CompiledScene<float>>);
template RenderPlan<double> planRender(const Scene&, const RenderSettings&,
                                       std::shared_ptr<const CompiledScene<double>>);

template <class S>
bool spreadsSamples(const RenderPlan<S>& plan, const RenderSettings& settings) {
  const bool samples = !plan.pipeline.chains || hasDirectPass(plan, settings);
  return samples && settings.filterMode == FilterMode::spread && canSpread(plan.view.camera);
}
template bool spreadsSamples(const RenderPlan<float>&, const RenderSettings&);
template bool spreadsSamples(const RenderPlan<double>&, const RenderSettings&);

MisSettings misSettings(MisSettings strategies, const MergeRadius& radius, size_t count, uint64_t iteration) {
  const auto lightPaths = static_cast<double>(count);
  strategies.lightPaths = lightPaths;
  strategies.radius = radius.at(iteration);
  // `density` is eta. The other constants follow from it (METHODS 5.1).
  const double density = std::numbers::pi * strategies.radius * strategies.radius * lightPaths;
  strategies.mergeNorm = 1 / density;
  if (strategies.merge && strategies.mergeWeights) strategies.vmWeight = strategies.connect ? density : 1;
  strategies.vcWeight = strategies.merge && strategies.connect ? 1 / density : 0;
  return strategies;
}

uint32_t pieceSize(size_t items, uint32_t threads, uint32_t most, uint32_t least) {
  constexpr size_t kPiecesPerThread = 16;
  if (threads <= 1) return most;
  // The size of one of `pieces` equal pieces, rounded up to whole blocks of lanes.
  const auto whole = [&](size_t pieces) { return piecesOf(piecesOf(items, pieces), kColumnPadding) * kColumnPadding; };
  // A piece and a half for each thread in any case.
  const size_t fewest = std::min<size_t>(least, whole(threads + threads / 2));
  return static_cast<uint32_t>(
      std::min<size_t>(most, std::max({whole(kPiecesPerThread * threads), fewest, kLeastPiece})));
}

size_t iterationsAtOnce(const RenderSettings& settings, size_t pixels) {
  constexpr size_t kPiecesPerThread = 8, kMost = 8;
  if (settings.cutForThreads() <= 1) return 1;
  // Take as many iterations as give each thread kPiecesPerThread pieces.
  const size_t lightPaths = lightPathsWanted(settings, pixels);
  const size_t pieces = piecesOf(pixels, settings.waveSize) + piecesOf(lightPaths, settings.waveSize);
  return std::clamp<size_t>(piecesOf(kPiecesPerThread * settings.cutForThreads(), pieces), 1, kMost);
}

size_t lightPathsWanted(const RenderSettings& settings, size_t pixels) {
  if (settings.lightPaths) return static_cast<size_t>(*settings.lightPaths);
  const PathStrategies strategies = strategiesOf(pageOf(settings));
  return strategies.merge && !strategies.connect ? std::max(pixels, kLeastLightPaths) : pixels;
}

RenderSettings withPieces(const RenderSettings& asked, const FilmSettings& film, size_t pixels) {
  RenderSettings settings = asked;
  // Where samples are spread, a wave has room for a tile.
  const bool spreads = settings.filterMode == FilterMode::spread && film.filter != ReconstructionFilter::box;
  const auto least = static_cast<uint32_t>(spreads ? kTilePixels : 1);
  settings.waveSize = std::max(settings.waveSize, least);
  RenderSettings cut = settings;
  const MethodPage page = pageOf(settings);
  const uint32_t threads = settings.cutForThreads();
  // Camera walks alone take several iterations of a pixel at once: their waves stay, over fewer pixels, up to so many
  // lanes of all threads.
  constexpr uint32_t kMostLanes = 1u << 17;
  if (!page.hasChains() && page.walk(Walk::light) == nullptr) {
    cut.waveSize = std::max(std::min(settings.waveSize, kMostLanes / std::max(threads, 1u)), least);
    return cut;
  }
  // Methods with light paths need few pieces: without a photon map pieces wait for nothing, so no thread is idle before
  // the end; with one, several iterations are under way.
  constexpr uint32_t kLeastWithLight = 256, kLeastWithMap = 512;
  if (page.hasChains()) {
    cut.waveSize = pieceSize(std::max<size_t>(settings.chainsOfShare(), 1), threads, settings.waveSize);
  } else {
    const size_t paths = std::max(pixels, lightPathsWanted(settings, pixels));
    cut.waveSize =
        pieceSize(paths, threads, settings.waveSize, page.has(Fold::photonMap) ? kLeastWithMap : kLeastWithLight);
  }
  cut.waveSize = std::max(cut.waveSize, least);
  return cut;
}

FilmArea filmOutline(const FilmSettings& film) {
  if (!film.isCropped()) return {.width = film.width, .height = film.height, .pixels = {}, .tiles = {}};
  return {.width = film.cropWidth,
          .height = film.cropHeight,
          .x0 = film.cropX,
          .y0 = film.cropY,
          .pixels = {},
          .tiles = {}};
}

uint64_t beginOfShare(uint64_t iterations, uint32_t part, uint32_t parts) {
  return static_cast<uint64_t>(static_cast<unsigned __int128>(iterations) * part / parts);
}

RenderSettings settingsOfShare(RenderSettings settings, uint32_t part, uint32_t parts) {
  assert(settings.iterations && part < parts);
  const uint64_t all = *settings.iterations;
  settings.share = {.part = part, .parts = parts, .iterations = all};
  // Chains of every share take all steps.
  if (settings.method == Method::mlt) return settings;
  settings.firstIteration = beginOfShare(all, part, parts);
  settings.iterations = beginOfShare(all, part + 1, parts) - settings.firstIteration;
  return settings;
}

RenderSettings settingsOfJointShare(RenderSettings settings, uint32_t part, uint32_t parts) {
  settings.share = {.part = part, .parts = parts, .iterations = settings.iterations, .rounds = true};
  // Chains of every share take all steps.
  if (settings.method != Method::mlt && settings.iterations) {
    settings.iterations = iterationsInRounds(*settings.iterations, part, parts);
  }
  return settings;
}

FilmArea filmArea(const FilmSettings& film) {
  const FilmArea outline = filmOutline(film);
  return FilmArea::make(outline.x0, outline.y0, outline.width, outline.height);
}

}  // namespace wavecrest
