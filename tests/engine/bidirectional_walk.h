// One wave of light paths and one of camera paths, walked stage by stage, with every contribution shown to a visitor
// before it reaches the film.
//
// in: a scene, the number of light paths and the merge radius that weights go by, and the strategies that share a path.
// out: calls to the visitor, in the order in which stages run. The paths depend on the seed and the iteration only, not
// on the strategies: two walks that differ in those alone meet the same contributions with different weights.
#pragma once

#include <memory>
#include <stdexcept>

#include "engine/plan/render_plan.h"
#include "engine/tasks/for_each.h"
#include "kernels/columns/light_vertices.h"
#include "kernels/merge/photon_map.h"

namespace wavecrest {

struct WalkSettings {
  uint64_t lightPaths = 1000;  // N_L of the weights
  double radius = 0.05;        // relative to the bounding sphere's
  uint64_t seed = 1;
  uint32_t iteration = 0;
  PathLimits limits{.maxDepth = 6, .rouletteDepth = 64};
  float rouletteBelow = 0;  // of connections
  Precision precision = Precision::floating;
};

// Every strategy by itself: all weights are 1.
constexpr MisSettings kAlone{.emission = false, .nextEvent = false, .mergeWeights = false};

// What a walk shows. Shadow rays are waiting to be traced; radiance holds what the named stage has added and nothing
// else. A visitor may call the walk's occlude(), which turns the former into the latter, or into the wave's splats.
template <class S>
struct WalkVisitor {
  virtual ~WalkVisitor() = default;
  virtual void generated(Walk, const Wave<S>&) {}
  // Before extend, with rays on their way; after arrive, with rays at vertices; after scatter, with new rays.
  virtual void leaving(Walk, uint32_t /*depth*/, const Wave<S>&) {}
  virtual void arrived(Walk, uint32_t /*depth*/, const Wave<S>&) {}
  virtual void scattered(Walk, uint32_t /*depth*/, const Wave<S>&) {}
  // s = depth + 1, t = 1
  virtual void splats(uint32_t /*depth*/, Wave<S>&) {}
  // s = 0, t = depth + 1: radiance
  virtual void emission(uint32_t /*depth*/, Wave<S>&) {}
  // s = 1, t = depth + 1: shadow rays
  virtual void nextEvent(uint32_t /*depth*/, Wave<S>&) {}
  // s = lightDepth + 1, t = depth + 1: shadow rays
  virtual void connection(uint32_t /*lightDepth*/, uint32_t /*depth*/, Wave<S>&) {}
  // Vertices of the camera paths are in the wave; the context is what the merge stage wants, but for its photon map.
  virtual void merging(uint32_t /*depth*/, Wave<S>&, StageContext<S>&) {}
};

template <class S>
class BidirectionalWalk {
 public:
  BidirectionalWalk(const Scene& scene, const WalkSettings& settings, const MisSettings& strategies)
      : settings_(settings),
        compiled_(compileScene<S>(scene, Accel::small)),
        stages_(findStages<S>(bestIsa(), settings.precision,
                              chooseSpecialization(sceneFeatures(scene) | kBidirectional, settings.precision))),
        area_(filmArea(scene.film)),
        wave_(area_.pixels.size(), kNeeds),
        light_(area_.pixels.size(), kNeeds) {
    context_.scene = &compiled_->view;
    context_.pixels = area_.pixels.data();
    context_.sampler = {SamplerKind::independent, settings.seed, settings.iteration};
    context_.limits = settings.limits;
    context_.mis =
        misSettings(strategies, {.first = settings.radius, .scene = compiled_->view.radius}, settings.lightPaths, 0);
    context_.light.grid = PhotonGrid<S>::over(compiled_->view.center, compiled_->view.radius, context_.mis.radius,
                                              static_cast<double>(settings.lightPaths));
    context_.counters = &counters;
    context_.film = area_.window();
    context_.light.rouletteBelow = static_cast<S>(settings.rouletteBelow);
  }

  StageCounters counters;

  // One iteration: all light paths, then all camera paths, as many of either as pixels.
  void run(uint32_t iteration, WalkVisitor<S>& visitor) {
    context_.sampler.iteration = iteration;
    wave_.pathCount = area_.pixels.size();
    walkLight(visitor);
    walkCamera(visitor);
  }

  // Traces the waiting shadow rays: into radiance on the camera's walk, into Splats on the light's.
  void occlude() { stages_.occludeSmall(context_, wave_); }

  const SceneView<S>& scene() const { return compiled_->view; }
  const FilmArea& area() const { return area_; }
  const LightStore<S>& light() const { return light_; }
  const MisSettings& mis() const { return context_.mis; }
  const PhotonGrid<S>& photonGrid() const { return context_.light.grid; }
  const PathLimits& limits() const { return settings_.limits; }
  const Stages<S>& stages() const { return stages_; }
  static constexpr ColumnNeeds kNeeds{
      .shadingNormals = true, .textures = true, .rouletteScale = true, .connections = true};

 private:
  void walkLight(WalkVisitor<S>& visitor) {
    context_.walk = Walk::light;
    context_.depth = 0;
    context_.light.store = &light_;
    light_.clear();
    stages_.generateLightPaths(context_, wave_);
    visitor.generated(Walk::light, wave_);
    for (context_.depth = 1; context_.depth <= settings_.limits.maxDepth && wave_.rays.size != 0; ++context_.depth) {
      light_.beginDepth(wave_.rays.size);
      visitor.leaving(Walk::light, context_.depth, wave_);
      stages_.extendSmall(context_, wave_);
      stages_.arrive(context_, wave_);
      visitor.arrived(Walk::light, context_.depth, wave_);
      stages_.storeLightVertices(context_, wave_);
      stages_.connectToCamera(context_, wave_);
      visitor.splats(context_.depth, wave_);
      wave_.shadowRays.size = wave_.splats.size = 0;
      stages_.scatter(context_, wave_);
      visitor.scattered(Walk::light, context_.depth, wave_);
    }
  }

  void walkCamera(WalkVisitor<S>& visitor) {
    context_.walk = Walk::camera;
    context_.depth = 0;
    stages_.generateCameraPaths(context_, wave_);
    visitor.generated(Walk::camera, wave_);
    for (context_.depth = 1; context_.depth <= settings_.limits.maxDepth && wave_.rays.size != 0; ++context_.depth) {
      visitor.leaving(Walk::camera, context_.depth, wave_);
      stages_.extendSmall(context_, wave_);
      stages_.arrive(context_, wave_);
      visitor.emission(context_.depth, wave_);
      clearContributions();
      visitor.arrived(Walk::camera, context_.depth, wave_);
      stages_.nextEvent(context_, wave_);
      visitor.nextEvent(context_.depth, wave_);
      clearContributions();
      for (uint32_t lightDepth = 1; lightDepth <= light_.depths(); ++lightDepth) connect(lightDepth, visitor);
      visitor.merging(context_.depth, wave_, context_);
      clearContributions();
      stages_.scatter(context_, wave_);
      visitor.scattered(Walk::camera, context_.depth, wave_);
    }
  }

  // One depth of light vertices has at most one pair to a lane: the first repetition joins them all.
  void connect(uint32_t lightDepth, WalkVisitor<S>& visitor) {
    context_.light.depths = {lightDepth, lightDepth};
    context_.light.repetition = 0;
    stages_.connectVertices(context_, wave_);
    visitor.connection(lightDepth, context_.depth, wave_);
    while (wave_.openPairs != 0) {
      ++context_.light.repetition;
      stages_.connectVertices(context_, wave_);
      if (wave_.shadowRays.size != 0) throw std::logic_error("connect: a pair of another depth");
    }
    clearContributions();
  }

  void clearContributions() {
    wave_.shadowRays.size = 0;
    for (size_t i = 0; i < wave_.radiance.size; ++i) {
      wave_.radiance.red[i] = wave_.radiance.green[i] = wave_.radiance.blue[i] = 0;
    }
  }

  const WalkSettings settings_;
  std::unique_ptr<CompiledScene<S>> compiled_;
  const Stages<S>& stages_;
  const FilmArea area_;
  Wave<S> wave_;
  LightStore<S> light_;
  StageContext<S> context_;
};

}  // namespace wavecrest
