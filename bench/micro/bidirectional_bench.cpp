// Time per item of what light paths add to a render: vertex connection, camera connection, splats, the photon map and
// merging, on made-up vertices between a floor and a ceiling. Names read STAGE/ISA/items or photons:COUNT.
//
// Merging searches for kPhotonsPerQuery photons on average whatever their number: its cost per query should stay flat
// while the map outgrows every cache. A wave's queries lie in one tile of the floor, as those of a wave of pixels do,
// and the tile changes from run to run. Before a stage is timed its result is compared with the scalar twin's.
#include <benchmark/benchmark.h>

#include <fmt/core.h>

#include <bit>
#include <memory>
#include <numbers>
#include <random>

#include "bench/machine/cpu_timer.h"
#include "bench/micro/registration.h"
#include "engine/film/splat_films.h"
#include "kernels/columns/light_vertices.h"
#include "kernels/merge/photon_map.h"
#include "tests/kernels/stage_scene.h"

namespace wavecrest {
namespace {

constexpr size_t kWave = 2048;
constexpr double kPhotonsPerQuery = 10;
constexpr size_t kTiles = 32;
constexpr ColumnNeeds kNeeds{
    .shadingNormals = false, .textures = false, .normalMaps = false, .rouletteScale = true, .connections = true};
constexpr Specialization kKernels = Specialization::diffuseBidirectional;

// The unit square z = 0, facing up, and z = 1, facing down; a camera in the middle looks at the floor.
StageScene<float>& room() {
  static StageScene<float> scene = [] {
    StageScene<float> made(
        {quadPrimitive({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), quadPrimitive({0, 0, 1}, {0, 1, 1}, {1, 0, 1})});
    CameraView camera;
    camera.width = camera.height = 64;
    camera.pixelDistance = 32;
    camera.planeDepth = 1;
    camera.inverseDu2 = camera.inverseDv2 = 32 * 32;
    const double origin[3] = {0.5, 0.5, 0.5}, corner[3] = {-1, -1, -1}, du[3] = {1 / 32.0, 0, 0},
                 dv[3] = {0, 1 / 32.0, 0}, axis[3] = {0, 0, -1};
    for (size_t i = 0; i < 3; ++i) {
      camera.origin[i] = origin[i];
      camera.corner[i] = corner[i];
      camera.du[i] = du[i];
      camera.dv[i] = dv[i];
      camera.axis[i] = axis[i];
    }
    made.setCamera(camera);
    return made;
  }();
  return scene;
}

MisSettings misFor(size_t lightPaths) {
  MisSettings mis{.emission = true, .nextEvent = true, .connect = true, .camera = true, .merge = true};
  mis.radius = std::sqrt(kPhotonsPerQuery / (std::numbers::pi * static_cast<double>(lightPaths)));
  mis.lightPaths = static_cast<double>(lightPaths);
  mis.vmWeight = kPhotonsPerQuery;
  mis.vcWeight = mis.mergeNorm = 1 / kPhotonsPerQuery;
  return mis;
}

class Random {
 public:
  explicit Random(uint64_t seed) : engine_(seed) {}
  float uniform(double low, double high) {
    return static_cast<float>(std::uniform_real_distribution<double>(low, high)(engine_));
  }

 private:
  std::mt19937_64 engine_;
};

// Vertices on the floor, in a square of this side.
void fillWave(Wave<float>& wave, size_t count, double side, Random& random) {
  const double x0 = random.uniform(0, 1 - side), y0 = random.uniform(0, 1 - side);
  wave.pathCount = wave.radiance.size = count;
  wave.setVertices(count, count);
  for (uint32_t i = 0; i < count; ++i) {
    wave.rays.originX[i] = random.uniform(x0, x0 + side);
    wave.rays.originY[i] = random.uniform(y0, y0 + side);
    wave.rays.originZ[i] = 0;
    wave.rays.directionX[i] = 0.6f;
    wave.rays.directionY[i] = 0;
    wave.rays.directionZ[i] = -0.8f;
    wave.hits.primitive[i] = 0;
    wave.surfaces.normalX[i] = wave.surfaces.normalY[i] = 0;
    wave.surfaces.normalZ[i] = 1;
    wave.surfaces.offset[i] = 1e-6f;
    wave.paths.throughputR[i] = wave.paths.throughputG[i] = wave.paths.throughputB[i] = 1;
    wave.paths.dVCM[i] = wave.paths.dVC[i] = random.uniform(0, 1);
    wave.paths.lane[i] = i;
    wave.radiance.red[i] = wave.radiance.green[i] = wave.radiance.blue[i] = 0;
  }
}

// One vertex per lane, on the floor (z = 0) or on the ceiling.
void fillStore(LightStore<float>& store, const PhotonGrid<float>& grid, size_t count, float z, Random& random) {
  store.clear();
  store.beginDepth(count);
  auto& v = store.vertices;
  v.claim(count);
  for (uint32_t i = 0; i < count; ++i) {
    v.lane[i] = i;
    const float up = z == 0 ? 1.0f : -1.0f, tilt = random.uniform(-0.7, 0.7), density = random.uniform(0, 1);
    const float cosine = std::sqrt(1 - tilt * tilt);
    v.row[i] = {.position = {random.uniform(0, 1), random.uniform(0, 1), z},
                .offset = 1e-6f,
                .wi = {tilt, 0, up * cosine},
                .tag = std::bit_cast<float>(1u << kMaterialBits),  // material 0, one edge from the light
                .normal = {0, 0, up},
                .dVCM = density,
                .throughput = {1, 1, 1},
                .dVC = density};
    const auto at = grid.at(v.row[i].position);
    v.cell[i] = at.cell;
    v.place[i] = at.place;
  }
  store.link(count, count);
}

// Light vertices of waves on the floor, side by side as a session has them, and the map over them.
struct PhotonField {
  Arena memory;
  std::vector<std::unique_ptr<LightStore<float>>> stores;
  std::vector<LightStore<float>*> pointers;
  PhotonGrid<float> grid;
  PhotonMap<float> map;

  explicit PhotonField(size_t count) {
    Random random(count);
    grid = PhotonGrid<float>::over({0.5, 0.5, 0.5}, 1, misFor(count).radius, static_cast<double>(count));
    for (size_t first = 0; first < count; first += kWave) {
      stores.push_back(std::make_unique<LightStore<float>>(kWave, kNeeds));
      if (first == 0) memory = Arena((count + kWave - 1) / kWave * stores[0]->arenaBytes(kWave));
      stores.back()->reserve(kWave, memory);
      fillStore(*stores.back(), grid, std::min(kWave, count - first), 0, random);
      pointers.push_back(stores.back().get());
    }
    build();
  }
  void build() {
    map.build(pointers, grid, [](size_t n, const std::function<void(size_t)>& body) {
      for (size_t i = 0; i < n; ++i) body(i);
    });
  }
  // One at a time: the largest takes gigabytes.
  static PhotonField& of(size_t count) {
    static std::pair<size_t, std::unique_ptr<PhotonField>> last;
    if (last.first != count) {
      last.second.reset();
      last = {count, std::make_unique<PhotonField>(count)};
    }
    return *last.second;
  }
};

StageContext<float> contextFor(size_t lightPaths, StageCounters& counters) {
  StageContext<float> context;
  context.scene = &room().view;
  context.pixels = room().pixels.data();
  context.mis = misFor(lightPaths);
  context.depth = 1;
  context.counters = &counters;
  return context;
}

double sumOf(const float* values, size_t count) {
  double sum = 0;
  for (size_t i = 0; i < count; ++i) sum += values[i];
  return sum;
}
// Whether a stage made what its twin did: light was found, and as much of it.
bool agrees(benchmark::State& state, double actual, double expected) {
  if (expected > 0 && std::abs(actual - expected) <= 1e-3 * expected) return true;
  state.SkipWithError(fmt::format("{} in place of the scalar twin's {}", actual, expected).c_str());
  return false;
}

void measureBuild(benchmark::State& state, size_t photons) {
  PhotonField& field = PhotonField::of(photons);
  if (field.map.size != photons) return state.SkipWithError("photons are missing in the map");
  CpuTimer timer;
  for (auto _ : state) {
    timer.start();
    field.build();
    state.SetIterationTime(timer.seconds());
  }
  reportItems(state, photons);
}

void measureMerge(benchmark::State& state, Stage<float> merge, Stage<float> twin, size_t photons) {
  StageCounters counters;
  StageContext<float> context = contextFor(photons, counters);
  context.light.photons = &PhotonField::of(photons).map;
  Random random(3);
  // As many of the camera's vertices as photons on the whole floor.
  const double side = std::sqrt(std::min(1.0, static_cast<double>(kWave) / static_cast<double>(photons)));
  std::vector<std::unique_ptr<Wave<float>>> waves;
  for (size_t i = 0; i < kTiles; ++i) {
    waves.push_back(std::make_unique<Wave<float>>(kWave, kNeeds));
    fillWave(*waves.back(), kWave, side, random);
  }
  Wave<float>& wave = *waves[0];
  twin(context, wave);
  const double expected = sumOf(wave.radiance.red, kWave);
  std::fill_n(static_cast<float*>(wave.radiance.red), kWave, 0.0f);
  wave.vertexRows.size = 0;  // as arrive leaves them: the stage packs them
  merge(context, wave);
  if (!agrees(state, sumOf(wave.radiance.red, kWave), expected)) return;

  counters = {};
  CpuTimer timer;
  size_t tile = 0;
  for (auto _ : state) {
    Wave<float>& next = *waves[tile++ % kTiles];
    next.vertexRows.size = 0;
    timer.start();
    merge(context, next);
    state.SetIterationTime(timer.seconds());
  }
  reportItems(state, kWave);
  state.counters["merges_per_query"] =
      static_cast<double>(counters.merges) / static_cast<double>(kWave * state.iterations());
}

// connectVertices of a camera walk or connectToCamera of a light walk: shadow rays out.
void measureConnection(benchmark::State& state, Walk walk, Stage<float> stage, Stage<float> twin, size_t items) {
  StageCounters counters;
  StageContext<float> context = contextFor(items, counters);
  context.walk = walk;
  context.film = {0, 0, 64, 64};
  Random random(5);
  Wave<float> wave(items, kNeeds);
  fillWave(wave, items, 1, random);
  LightStore<float> store(items, kNeeds);
  fillStore(store, {}, items, 1, random);
  context.light.store = &store;
  twin(context, wave);
  const double expected = sumOf(wave.shadowRays.red, wave.shadowRays.size);
  wave.vertexRows.size = 0;  // as arrive leaves them: the stage packs them
  stage(context, wave);
  if (!agrees(state, sumOf(wave.shadowRays.red, wave.shadowRays.size), expected)) return;
  CpuTimer timer;
  for (auto _ : state) {
    wave.vertexRows.size = 0;
    timer.start();
    stage(context, wave);
    state.SetIterationTime(timer.seconds());
  }
  reportItems(state, items);
}

// Splats of a wave, added to the sums of a film of this many pixels.
void measureSplat(benchmark::State& state, AddSplats<float> addSplats, size_t pixels) {
  StageCounters counters;
  SplatFilms films(pixels, 1, 0x1p48);
  Wave<float> wave(kWave, kNeeds);
  std::mt19937_64 random(7);
  const auto fill = [&] {
    for (size_t i = 0; i < kWave; ++i) {
      wave.splats.red[i] = wave.splats.green[i] = wave.splats.blue[i] = 1;
      wave.splats.pixel[i] = static_cast<uint32_t>(random() % pixels);
    }
  };
  const SplatSums& sums = films.assign().sums();
  fill();
  addSplats(wave.splats, 0, kWave, sums, counters);
  double sum = 0;
  for (size_t channel = 0; channel < 3 * pixels; ++channel) sum += films.total(channel) / films.scale();
  if (!agrees(state, sum, 3.0 * kWave)) return;
  CpuTimer timer;
  for (auto _ : state) {
    fill();
    timer.start();
    addSplats(wave.splats, 0, kWave, sums, counters);
    state.SetIterationTime(timer.seconds());
  }
  reportItems(state, kWave);
}

}  // namespace

void registerBidirectionalBenchmarks() {
  const Stages<float>& twin = findStages<float>(availableIsas().front(), Precision::floating, kKernels);
  for (size_t photons = 1000; photons <= 10'000'000; photons *= 10) {
    registerBenchmark(fmt::format("photonMap/photons:{}", photons),
                      [=](benchmark::State& state) { measureBuild(state, photons); });
    for (const Isa isa : availableIsas()) {
      const Stages<float>& stages = findStages<float>(isa, Precision::floating, kKernels);
      registerBenchmark(
          fmt::format("merge/{}/photons:{}", toString(isa), photons),
          [=, &stages](benchmark::State& state) { measureMerge(state, stages.merge, twin.merge, photons); });
    }
  }
  for (const Isa isa : availableIsas()) {
    const Stages<float>& stages = findStages<float>(isa, Precision::floating, kKernels);
    for (const size_t items : {size_t{256}, kWave, size_t{16384}}) {
      registerBenchmark(fmt::format("connectVertices/{}/items:{}", toString(isa), items),
                        [=, &stages](benchmark::State& state) {
                          measureConnection(state, Walk::camera, stages.connectVertices, twin.connectVertices, items);
                        });
      registerBenchmark(fmt::format("connectToCamera/{}/items:{}", toString(isa), items),
                        [=, &stages](benchmark::State& state) {
                          measureConnection(state, Walk::light, stages.connectToCamera, twin.connectToCamera, items);
                        });
    }
    for (size_t pixels = 1000; pixels <= 10'000'000; pixels *= 100) {
      registerBenchmark(fmt::format("splat/{}/pixels:{}", toString(isa), pixels),
                        [=, &stages](benchmark::State& state) { measureSplat(state, stages.addSplats, pixels); });
    }
  }
}

}  // namespace wavecrest
