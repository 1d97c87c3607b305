#include "engine/memory_plan.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "engine/flush_to_zero.h"
#include "kernels/columns/light_vertices.h"
#include "kernels/merge/photon_map.h"

namespace wavecrest {
namespace {

constexpr double kMegabyte = 1e6;

// Waves of light paths on which stored vertices are counted.
constexpr size_t kPilotWaves = 4;

// Iterations differ in how many vertices they store; the plan leaves room for this much more than the mean.
constexpr double kSpread = 1.05;

template <class T>
uint64_t bytesOf(const std::vector<T>& list) {
  return list.size() * sizeof(T);
}

template <class S>
uint64_t sceneBytes(const CompiledScene<S>& scene) {
  const auto& environment = scene.lights.environment;
  uint64_t bytes = bytesOf(scene.primitives.records) + bytesOf(scene.primitives.attributes) + bytesOf(scene.materials) +
                   bytesOf(scene.lights.records) + bytesOf(scene.lights.table) + bytesOf(scene.textures.records) +
                   bytesOf(scene.textures.texels) + bytesOf(environment.texels) + bytesOf(environment.probability) +
                   bytesOf(environment.table);
  if (scene.embree) bytes += scene.embree->bytes();
  return bytes;
}

// How many vertices the light paths of the first iteration store.
struct Pilot {
  double verticesPerPath = 0;
  size_t longest = 0;  // vertices of the longest
};
template <class S>
Pilot tracePilot(const RenderPlan<S>& plan, const RenderSettings& settings, size_t lightPaths) {
  const FlushToZero flushToZero;
  Wave<S> wave(settings.waveSize, plan.needs);
  LightStore<S> store(settings.waveSize, plan.needs);
  StageCounters counters;
  StageContext<S> context;
  context.scene = &plan.scene->view;
  context.sampler = {settings.sampler, settings.seed, 0};
  context.limits = settings.limits;
  context.light = &store;
  context.counters = &counters;
  Pass<S> pass = *plan.pipeline.lightPass;
  context.mis = pass.strategies;
  // Only what stores: splats have nowhere to go yet.
  std::erase_if(pass.perDepth, [](const StageCall<S>& call) { return call.items == shadowItems<S>; });
  size_t paths = 0, longest = 0;
  for (size_t i = 0; i < kPilotWaves && paths < lightPaths; ++i) {
    wave.firstPath = paths;
    wave.pathCount = std::min<size_t>(settings.waveSize, lightPaths - paths);
    runPass(pass, context, wave, nullptr);
    paths += wave.pathCount;
    longest = std::max<size_t>(longest, store.depths());
  }
  return {static_cast<double>(counters.lightVertices) / static_cast<double>(std::max<size_t>(paths, 1)), longest};
}

template <class S>
class Planner {
 public:
  Planner(const RenderPlan<S>& plan, const RenderSettings& settings, size_t pixels)
      : plan_(plan), settings_(settings), pixels_(pixels) {
    if (settings.lightPaths && !plan.pipeline.photonMap) {
      throw std::invalid_argument("planMemory: a number of light paths for " + std::string(toString(settings.method)));
    }
    memory_.lightPaths = plan.pipeline.bidirectional() ? settings.lightPaths.value_or(pixels) : 0;
    if (plan.pipeline.photonMap) {
      pilot_ = tracePilot(plan, settings, static_cast<size_t>(memory_.lightPaths));
      memory_.verticesPerLightPath = pilot_.verticesPerPath;
    }
  }

  MemoryPlan run() {
    addFixedItems();
    if (plan_.pipeline.photonMap) {
      if (settings_.memoryBytes) fitLightPaths(*settings_.memoryBytes);
      memory_.items.push_back({"light vertices", vertexBytes(memory_.lightPaths)});
      memory_.items.push_back({"photon map", photonBytes(memory_.lightPaths)});
    }
    if (settings_.memoryBytes && memory_.total() > *settings_.memoryBytes) refuse(memory_.total());
    return memory_;
  }

 private:
  void addFixedItems() {
    const uint64_t threads = settings_.threads;
    memory_.items.push_back({"scene", sceneBytes(*plan_.scene)});
    memory_.items.push_back({"film", pixels_ * (3 * sizeof(double) + 2 * sizeof(uint32_t))});
    // One sum for each thread, and the total.
    if (plan_.pipeline.splats()) memory_.items.push_back({"splats", (threads + 1) * pixels_ * 3 * sizeof(int64_t)});
    Wave<S> wave(1, plan_.needs);
    LightStore<S> store(1, plan_.needs);
    uint64_t perPath = wave.bytesPerPath();
    // A wave's own light vertices: some 8 per path at most, or none where a photon map gathers all.
    if (plan_.pipeline.bidirectional()) perPath += 8 * store.vertices.bytesPerItem();
    memory_.items.push_back({"waves", threads * settings_.waveSize * perPath});
  }

  uint64_t vertexBytes(uint64_t lightPaths) const {
    const uint64_t waves = (lightPaths + settings_.waveSize - 1) / settings_.waveSize;
    const LightStore<S> store(settings_.waveSize, plan_.needs);
    return waves * store.bytesFor(memory_.verticesOf(settings_.waveSize), pilot_.longest + pilot_.longest / 4);
  }
  uint64_t photonBytes(uint64_t lightPaths) const {
    return PhotonMap<S>::bytesFor(memory_.verticesOf(static_cast<size_t>(lightPaths)));
  }

  // The most light paths, up to those asked for, that leave the plan within the budget.
  void fitLightPaths(uint64_t budget) {
    const uint64_t fixed = memory_.total();
    const auto needed = [&](uint64_t paths) { return fixed + vertexBytes(paths) + photonBytes(paths); };
    const uint64_t least = std::min<uint64_t>(settings_.waveSize, memory_.lightPaths);
    if (needed(least) > budget) refuse(needed(least));
    uint64_t fits = least, most = memory_.lightPaths;
    while (fits < most) {
      const uint64_t middle = fits + (most - fits + 1) / 2;
      if (needed(middle) <= budget) {
        fits = middle;
      } else {
        most = middle - 1;
      }
    }
    memory_.lightPaths = fits;
  }

  [[noreturn]] void refuse(uint64_t needed) const {
    char text[160];
    std::snprintf(text, sizeof text,
                  "%s needs %.1f MB for this scene; expected a memory budget of at least that, not %.1f MB",
                  std::string(toString(settings_.method)).c_str(), std::ceil(static_cast<double>(needed) / 1e5) / 10,
                  static_cast<double>(*settings_.memoryBytes) / kMegabyte);
    throw MemoryBudgetError(text);
  }

  const RenderPlan<S>& plan_;
  const RenderSettings& settings_;
  const size_t pixels_;
  Pilot pilot_;
  MemoryPlan memory_;
};

}  // namespace

uint64_t MemoryPlan::total() const {
  uint64_t sum = 0;
  for (const Item& item : items) sum += item.bytes;
  return sum;
}

size_t MemoryPlan::verticesOf(size_t paths) const {
  return static_cast<size_t>(std::ceil(verticesPerLightPath * kSpread * static_cast<double>(paths)));
}

std::string MemoryPlan::describe() const {
  std::string text;
  char part[96];
  const auto megabytes = [](uint64_t bytes) { return static_cast<double>(bytes) / kMegabyte; };
  for (const Item& item : items) {
    std::snprintf(part, sizeof part, "%s%s %.1f MB", text.empty() ? "" : ", ", std::string(item.name).c_str(),
                  megabytes(item.bytes));
    text += part;
  }
  std::snprintf(part, sizeof part, "; together %.1f MB", megabytes(total()));
  text += part;
  if (lightPaths != 0) text += "; " + std::to_string(lightPaths) + " light paths in each iteration";
  if (verticesPerLightPath > 0) {
    std::snprintf(part, sizeof part, " of %.2f vertices", verticesPerLightPath);
    text += part;
  }
  return text;
}

template <class S>
MemoryPlan planMemory(const RenderPlan<S>& plan, const RenderSettings& settings, size_t pixels) {
  return Planner<S>(plan, settings, pixels).run();
}
template MemoryPlan planMemory(const RenderPlan<float>&, const RenderSettings&, size_t);
template MemoryPlan planMemory(const RenderPlan<double>&, const RenderSettings&, size_t);

MemoryPlan planMemory(const Scene& scene, const RenderSettings& settings) {
  const size_t pixels = filmArea(scene.film).pixels.size();
  if (settings.precision == Precision::doubled)
    return planMemory(planRender<double>(scene, settings), settings, pixels);
  return planMemory(planRender<float>(scene, settings), settings, pixels);
}

}  // namespace wavecrest
