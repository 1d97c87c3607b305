// Time of closest hits and of shadow rays per ray among a thousand instances of a mesh of two thousand triangles: in a
// hierarchy of two levels, and in one over copies. Names read STAGE/instances/ISA/HOW/depth:VERTEX.
//
// Before a stage is timed, its result is compared with that of the other hierarchy on the same rays.
#include <benchmark/benchmark.h>

#include <fmt/core.h>

#include <cmath>
#include <numbers>

#include "bench/machine/cpu_timer.h"
#include "bench/micro/registration.h"
#include "bench/throughput/wave_capture.h"

namespace wavecrest {
namespace {

constexpr double kAllowedDifference = 4e-3;  // of rays: those that pass an edge within its rounding

// A knot of a tube, so that its box is mostly empty.
Mesh knot() {
  constexpr uint32_t kAlong = 128, kAround = 8;
  constexpr double kTurn = 2 * std::numbers::pi;
  Mesh mesh;
  for (uint32_t i = 0; i < kAlong; ++i) {
    const double t = kTurn * i / kAlong;
    const double x = (2 + std::cos(3 * t)) * std::cos(2 * t), y = (2 + std::cos(3 * t)) * std::sin(2 * t);
    for (uint32_t j = 0; j < kAround; ++j) {
      const double s = kTurn * j / kAround, out = 1 + 0.3 * std::cos(s) / 3;
      mesh.positions.push_back({static_cast<float>(x * out), static_cast<float>(y * out),
                                static_cast<float>(std::sin(3 * t) + 0.3 * std::sin(s))});
      const uint32_t a = i * kAround + j, b = i * kAround + (j + 1) % kAround;
      const uint32_t c = (a + kAround) % (kAlong * kAround), d = (b + kAround) % (kAlong * kAround);
      mesh.triangles.push_back({a, c, b});
      mesh.triangles.push_back({b, c, d});
    }
  }
  return mesh;
}

Scene crowd() {
  constexpr uint32_t kAcross = 10;
  Scene scene;
  scene.name = "crowd";
  scene.materials.push_back({});
  scene.materials.back().kind = Diffuse{};
  scene.groups.push_back({.id = "knot", .source = {}});
  scene.shapes.push_back({.id = {}, .kind = knot(), .material = 0, .emitter = kNone, .group = 0, .source = {}});
  for (uint32_t i = 0; i < kAcross * kAcross * kAcross; ++i) {
    const double angle = i, c = std::cos(angle), s = std::sin(angle);
    const auto along = [](uint32_t cell) { return 6.0 * static_cast<double>(cell % kAcross); };
    const double x = along(i), y = along(i / kAcross), z = along(i / kAcross / kAcross);
    scene.instances.push_back({.id = {},
                               .group = 0,
                               .toWorld = {{{c, 0, s, x - 27}, {0, 1.2, 0, y - 27}, {-s, 0, c, -z}, {0, 0, 0, 1}}},
                               .source = {}});
  }
  Emitter sky;
  sky.kind = ConstantEmitter{{1, 1, 1}};
  scene.emitters.push_back(sky);
  scene.sensor.toWorld = {{{-1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, -1, 40}, {0, 0, 0, 1}}};
  scene.film.width = 256;
  scene.film.height = 192;
  return scene;
}

struct Capture {
  Scene scene = crowd();
  WaveCapture<float> capture;
  explicit Capture(Instancing instancing) : capture(scene, settings(instancing)) {}
  static RenderSettings settings(Instancing instancing) {
    RenderSettings settings;
    settings.isa = bestIsa();
    settings.accel = Accel::bvh;
    settings.instancing = instancing;
    return settings;
  }
  static Capture& of(Instancing instancing) {
    static Capture kept(Instancing::kept), copied(Instancing::expanded);
    return instancing == Instancing::kept ? kept : copied;
  }
};

// What the rays of a wave have met, one number each.
std::vector<bool> results(const Wave<float>& wave, bool extend) {
  std::vector<bool> out(wave.pathCount);
  if (extend) {
    for (size_t i = 0; i < wave.hits.size; ++i) out[wave.paths.lane[i]] = wave.hits.primitive[i] != kMiss;
  } else {
    for (size_t i = 0; i < wave.pathCount; ++i) out[i] = wave.radiance.red[i] > 0;
  }
  return out;
}

void measure(benchmark::State& state, bool extend, Isa isa, Instancing instancing, uint32_t depth) {
  const char* const name = extend ? "extend" : "occlude";
  Capture& own = Capture::of(instancing);
  Capture& other = Capture::of(instancing == Instancing::kept ? Instancing::expanded : Instancing::kept);
  const auto stageOf = [&](Capture& capture) {
    const auto& plan = capture.capture.plan();
    const auto& stages = findStages<float>(isa, Precision::floating, plan.specialization);
    const Intersector<float> intersector = chooseIntersector(stages, *plan.scene);
    return extend ? intersector.extend : intersector.occlude;
  };
  // Rays of the scene with copies, in either: waves of both have the columns that are read.
  const Wave<float> rays = Capture::of(Instancing::expanded).capture.before(name, depth);
  const auto load = [&](Wave<float>& wave) {
    wave.setVertices(rays.rays.size, 0);
    wave.pathCount = rays.pathCount;
    const auto copy = [](const auto& from, const auto& to, size_t count) { std::copy_n(+from, count, +to); };
    for (const auto& [from, to] :
         {std::pair{&rays.rays.originX, &wave.rays.originX}, std::pair{&rays.rays.originY, &wave.rays.originY},
          std::pair{&rays.rays.originZ, &wave.rays.originZ}, std::pair{&rays.rays.directionX, &wave.rays.directionX},
          std::pair{&rays.rays.directionY, &wave.rays.directionY},
          std::pair{&rays.rays.directionZ, &wave.rays.directionZ}}) {
      copy(*from, *to, rays.rays.size);
    }
    copy(rays.paths.lane, wave.paths.lane, rays.paths.size);
    wave.shadowRays.size = rays.shadowRays.size;
    const auto &a = rays.shadowRays, &b = wave.shadowRays;
    for (const auto& [from, to] :
         {std::pair{&a.originX, &b.originX}, std::pair{&a.originY, &b.originY}, std::pair{&a.originZ, &b.originZ},
          std::pair{&a.directionX, &b.directionX}, std::pair{&a.directionY, &b.directionY},
          std::pair{&a.directionZ, &b.directionZ}, std::pair{&a.red, &b.red}, std::pair{&a.green, &b.green},
          std::pair{&a.blue, &b.blue}}) {
      copy(*from, *to, a.size);
    }
    copy(a.target, b.target, a.size);
    wave.radiance.size = rays.radiance.size;
    std::fill_n(+wave.radiance.red, wave.pathCount, 0.0f);
  };
  const auto run = [&](Capture& capture, Wave<float>& wave) {
    load(wave);
    stageOf(capture)(capture.capture.context(depth), wave);
  };
  Wave<float> wave = own.capture.makeWave(), twin = other.capture.makeWave();
  run(own, wave);
  run(other, twin);
  const std::vector<bool> got = results(wave, extend), expected = results(twin, extend);
  size_t differing = 0;
  for (size_t i = 0; i < got.size(); ++i) differing += got[i] != expected[i] ? 1 : 0;
  if (static_cast<double>(differing) > kAllowedDifference * static_cast<double>(got.size())) {
    state.SkipWithError(fmt::format("{} of {} rays differ from the other hierarchy", differing, got.size()).c_str());
    return;
  }

  const Stage<float> stage = stageOf(own);
  const StageContext<float> context = own.capture.context(depth);
  CpuTimer timer;
  for (auto _ : state) {
    load(wave);
    timer.start();
    stage(context, wave);
    state.SetIterationTime(timer.seconds());
  }
  reportItems(state, extend ? rays.rays.size : rays.shadowRays.size);
}

}  // namespace

void registerInstanceBenchmarks() {
  for (const bool extend : {true, false}) {
    for (const Isa isa : availableIsas()) {
      for (const Instancing instancing : {Instancing::kept, Instancing::expanded}) {
        for (const uint32_t depth : {1u, 3u}) {
          registerBenchmark(fmt::format("{}/instances/{}/{}/depth:{}", extend ? "extend" : "occlude", toString(isa),
                                        instancing == Instancing::kept ? "kept" : "copied", depth),
                            [=](benchmark::State& state) { measure(state, extend, isa, instancing, depth); });
        }
      }
    }
  }
}

}  // namespace wavecrest
