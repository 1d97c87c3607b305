// The intersectors over the number of primitives: where those of small and of large scenes cross is kSmallSceneLimit
// (engine/compile/compiled_scene.h), and beyond it stands how the cost of a hierarchy grows. Names read
// crossover/STAGE/INTERSECTOR/quads:N.
//
// The scene is a closed room with randomly placed parallelograms in it; the rays are those of real paths after their
// second bounce, at the best instruction set in float. All are checked before they are timed: against the scalar
// small-scene intersector, or where that would take too long, against the scalar walk of the hierarchy.
#include <benchmark/benchmark.h>

#include <fmt/core.h>

#include <memory>
#include <random>

#include "bench/machine/cpu_timer.h"
#include "bench/micro/registration.h"
#include "bench/micro/wave_agreement.h"
#include "bench/throughput/wave_capture.h"

namespace wavecrest {
namespace {

constexpr double kAllowedAtEdges = 1e-2;  // at the many edges the intersectors may see either neighbour

void addQuad(Scene& scene, const Double3& corner, const Double3& edgeU, const Double3& edgeV) {
  Shape shape;
  shape.kind = Rectangle{corner, edgeU, edgeV, false};
  shape.material = 0;
  scene.shapes.push_back(shape);
}

// The room is the cube [-1, 1]^3 with the camera in its middle; its ceiling is the light.
Scene randomQuads(size_t count) {
  Scene scene;
  scene.name = fmt::format("{} random quads", count);
  Material& grey = scene.materials.emplace_back();
  grey.kind = Diffuse{{{0.7, 0.7, 0.7}}};
  grey.twoSided = true;
  addQuad(scene, {-1, 1, -1}, {2, 0, 0}, {0, 0, 2});  // normal down
  addQuad(scene, {-1, -1, -1}, {0, 0, 2}, {2, 0, 0});
  addQuad(scene, {-1, -1, -1}, {0, 2, 0}, {0, 0, 2});
  addQuad(scene, {1, -1, -1}, {0, 2, 0}, {0, 0, 2});
  addQuad(scene, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0});
  addQuad(scene, {-1, -1, 1}, {2, 0, 0}, {0, 2, 0});

  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-0.9, 0.9), edge(-0.2, 0.2);
  while (scene.shapes.size() < count) {
    addQuad(scene, {place(random), place(random), place(random)}, {edge(random), edge(random), edge(random)},
            {edge(random), edge(random), edge(random)});
  }
  scene.shapes.front().emitter = 0;
  scene.emitters.push_back({.kind = AreaEmitter{.radiance = {{1, 1, 1}}, .shape = 0}, .source = {}});
  for (size_t i = 0; i < 4; ++i) scene.sensor.toWorld[i][i] = 1;
  scene.sensor.fovX = 90;
  scene.film.width = scene.film.height = 128;
  return scene;
}

constexpr size_t kMostForSmall = 512;  // primitives

struct Rays {
  std::unique_ptr<WaveCapture<float>> small, bvh, embree;
  explicit Rays(const Scene& scene) {
    bvh = capture(scene, Accel::bvh);
    embree = capture(scene, Accel::embree);
    bvh->plan().view.embree = embree->plan().view.embree;
    if (scene.shapes.size() > kMostForSmall) return;
    small = capture(scene, Accel::small);
    bvh->plan().view.small = small->plan().view.small;
  }
  static std::unique_ptr<WaveCapture<float>> capture(const Scene& scene, Accel accel) {
    RenderSettings settings;
    settings.isa = bestIsa();
    settings.accel = accel;
    return std::make_unique<WaveCapture<float>>(scene, settings);
  }
};

Stage<float> stageOf(Isa isa, Accel accel, bool extend) {
  const auto& stages = findStages<float>(isa, Precision::floating, Specialization::diffuse);
  if (accel == Accel::small) return extend ? stages.extendSmall : stages.occludeSmall;
  if (accel == Accel::bvh) return extend ? stages.extendBvh : stages.occludeBvh;
  return extend ? extendEmbree<float> : occludeEmbree<float>;
}

void measure(benchmark::State& state, size_t quads, bool extend, Accel accel) {
  Rays rays(randomQuads(quads));
  WaveCapture<float>& source = *rays.bvh;
  const Wave<float> input = source.before(extend ? "extend" : "occlude", 3);
  const StageContext<float> context = source.context(3);
  const Stage<float> run = stageOf(bestIsa(), accel, extend);
  const Stage<float> twin = stageOf(availableIsas().front(), rays.small ? Accel::small : Accel::bvh, extend);
  Wave<float> expected = source.makeWave(), wave = source.makeWave();
  expected.copyFrom(input);
  wave.copyFrom(input);
  twin(context, expected);
  run(context, wave);
  const Agreement agreement = compareWaves(expected, wave, 1e-2);
  if (agreement.differingFraction() > kAllowedAtEdges) {
    state.SkipWithError(fmt::format("{} of {} paths differ", agreement.differing, agreement.items).c_str());
    return;
  }

  CpuTimer timer;
  for (auto _ : state) {
    wave.copyFrom(input);
    timer.start();
    run(context, wave);
    state.SetIterationTime(timer.seconds());
  }
  reportItems(state, extend ? input.rays.size : input.shadowRays.size);
}

}  // namespace

void registerCrossoverBenchmarks() {
  for (const bool extend : {true, false}) {
    for (const size_t quads : {8, 16, 32, 48, 64, 96, 128, 192, 256, 384, 512, 4096, 32768, 262144}) {
      for (const Accel accel : {Accel::small, Accel::bvh, Accel::embree}) {
        if (accel == Accel::small && quads > kMostForSmall) continue;
        registerBenchmark(fmt::format("crossover/{}/{}/quads:{}", extend ? "extend" : "occlude",
                                      kAccelNames[static_cast<size_t>(accel)], quads),
                          [=](benchmark::State& state) { measure(state, quads, extend, accel); });
      }
    }
  }
}

}  // namespace wavecrest
