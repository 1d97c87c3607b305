// No heap allocation while a wave runs. An executable of its own, because it replaces the global operator new by one
// that counts.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <tuple>
#include <vector>

#include "engine/chains/chain_worker.h"
#include "engine/plan/chain_layout.h"
#include "engine/plan/pipeline.h"
#include "engine/plan/render_plan.h"
#include "engine/walks/run_walk.h"
#include "tests/engine/test_scenes.h"

namespace {

std::atomic<bool> counting{false};
std::atomic<size_t> allocations{0};

void* allocate(size_t bytes, size_t alignment) {
  if (counting.load(std::memory_order_relaxed)) allocations.fetch_add(1, std::memory_order_relaxed);
  void* memory =
      std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment + (bytes == 0 ? alignment : 0));
  if (memory == nullptr) throw std::bad_alloc();  // from noexcept forms too: it ends the test
  return memory;
}

}  // namespace

void* operator new(size_t bytes) { return allocate(bytes, alignof(std::max_align_t)); }
void* operator new[](size_t bytes) { return allocate(bytes, alignof(std::max_align_t)); }
void* operator new(size_t bytes, std::align_val_t alignment) { return allocate(bytes, static_cast<size_t>(alignment)); }
void* operator new[](size_t bytes, std::align_val_t alignment) {
  return allocate(bytes, static_cast<size_t>(alignment));
}
// What std::stable_sort asks for.
void* operator new(size_t bytes, const std::nothrow_t&) noexcept { return allocate(bytes, alignof(std::max_align_t)); }
void* operator new[](size_t bytes, const std::nothrow_t&) noexcept {
  return allocate(bytes, alignof(std::max_align_t));
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete[](void* p) noexcept { std::free(p); }
void operator delete(void* p, size_t) noexcept { std::free(p); }
void operator delete[](void* p, size_t) noexcept { std::free(p); }
void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete[](void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete(void* p, size_t, std::align_val_t) noexcept { std::free(p); }
void operator delete[](void* p, size_t, std::align_val_t) noexcept { std::free(p); }

namespace wavecrest {
namespace {

// Allocations during the call.
template <class Function>
size_t allocationsOf(Function&& function) {
  allocations = 0;
  counting = true;
  function();
  counting = false;
  return allocations;
}

TEST(Allocation, isCounted) {
  EXPECT_EQ(allocationsOf([] { std::vector<int> some(10); }), 1u);
  EXPECT_EQ(allocationsOf([] {
              struct alignas(64) Wide {
                char c[64];
              };
              Wide* volatile kept = new Wide;  // volatile: a compiler may leave out a pair of new and delete
              delete kept;
            }),
            1u);
  EXPECT_EQ(allocationsOf([] {}), 0u);
}

// Runs iterations of one wave; the first may let the light store grow to what the wave needs.
template <class S>
size_t allocationsPerWave(const std::string& sceneName, const RenderSettings& settings) {
  const Scene scene = sceneFile(sceneName, 48, 36);
  const RenderPlan<S> plan = planRender<S>(scene, settings);
  const FilmArea area = filmArea(scene.film);
  Wave<S> wave(1024, plan.needs);
  StageCounters counters;
  StageContext<S> context;
  context.scene = &plan.view;
  context.pixels = area.pixels.data();
  context.sampler.kind = settings.sampler;
  context.counters = &counters;
  context.mis = plan.pipeline.cameraPass().strategies;
  std::vector<StageTally> tallies(plan.pipeline.cameraPass().stageCount());
  wave.pathCount = 1000;
  const auto run = [&] { runPass(plan.pipeline.cameraPass(), context, wave, tallies.data()); };
  run();
  const size_t count = allocationsOf([&] {
    for (context.sampler.iteration = 1; context.sampler.iteration <= 4; ++context.sampler.iteration) run();
  });
  EXPECT_GT(counters.raysClosest, 10'000u);
  EXPECT_GT(counters.raysShadow, 1'000u);
  return count;
}

class WaveAllocationTest : public testing::TestWithParam<std::tuple<Accel, SamplerKind>> {};

TEST_P(WaveAllocationTest, isNoneForAnyPrecision) {
  RenderSettings settings;
  settings.isa = bestIsa();
  std::tie(settings.accel, settings.sampler) = GetParam();
  for (const char* scene : {"cornell-diffuse", "cornell-mirror"}) {
    settings.precision = Precision::floating;
    EXPECT_EQ(allocationsPerWave<float>(scene, settings), 0u) << scene;
    settings.precision = Precision::doubled;
    EXPECT_EQ(allocationsPerWave<double>(scene, settings), 0u) << scene;
  }
}

// A step of the chains, from proposal to acceptance.
TEST(ChainAllocation, isNoneForAnyStep) {
  for (const MetropolisVariant variant :
       {MetropolisVariant::pssmlt, MetropolisVariant::mmlt, MetropolisVariant::pathspace}) {
    RenderSettings settings;
    settings.isa = bestIsa();
    settings.method = Method::mlt;
    settings.metropolis.variant = variant;
    const Scene scene = sceneFile("cornell-mirror", 48, 36);
    const RenderPlan<float> plan = planRender<float>(scene, settings);
    const FilmArea area = filmArea(scene.film);
    constexpr size_t kChains = 500;
    SplatFilms films(area.pixels.size(), 1, 1.0);
    ChainWorker<float> worker(plan, 512, films);
    ChainState state(kChains, keptSamples(plan.pipeline, plan.view, settings.limits.maxDepth));
    state.multiplexed = variant != MetropolisVariant::pssmlt;
    const bool pathSpace = variant == MetropolisVariant::pathspace;
    PathStore<float> paths(kChains, pathSpace ? plan.pathLaws.law().maxEdges : 1, plan.needs);
    for (uint32_t i = 0; i < kChains; ++i) {
      state.columns.source[i] = i;
      state.columns.length[i] = 1 + i % 9;
    }
    StageContext<float> context = chainContext(plan, settings, area);
    const auto run = [&](uint32_t first, uint32_t last) {
      for (context.sampler.iteration = first; context.sampler.iteration < last; ++context.sampler.iteration) {
        worker.trace(context, state, kChains, true, &paths);
        worker.decide(context, state, true);
      }
    };
    run(0, 1);  // the clock's ticks are measured once
    EXPECT_EQ(allocationsOf([&] { run(1, 20); }), 0u);
    uint64_t mutated = 0;  // by anything but large steps
    for (const uint64_t accepted : state.counters.accepted) mutated += accepted;
    EXPECT_GT(mutated - state.counters.acceptedOf(Mutation::large), 1'000u);
  }
}

INSTANTIATE_TEST_SUITE_P(PathTracing, WaveAllocationTest,
                         testing::Combine(testing::Values(Accel::embree, Accel::small, Accel::bvh),
                                          testing::ValuesIn(kAllSamplerKinds)),
                         [](const auto& instance) {
                           return std::string(kAccelNames[static_cast<size_t>(std::get<0>(instance.param))]) + "_" +
                                  std::string(toString(std::get<1>(instance.param)));
                         });

}  // namespace
}  // namespace wavecrest
