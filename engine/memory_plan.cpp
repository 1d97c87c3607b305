#include "engine/memory_plan.h"

#include <algorithm>

#include "engine/flush_to_zero.h"
#include "kernels/columns/light_vertices.h"
#include "kernels/merge/photon_map.h"

namespace wavecrest {
namespace {

template <class T>
size_t bytesOf(const std::vector<T>& items) {
  return items.size() * sizeof(T);
}

// Walks the light paths of the iteration's first wave into a store of their own.
template <class S>
size_t walkLightPaths(const RenderPlan<S>& plan, const RenderSettings& settings, const FilmArea& area,
                      LightStore<S>& store) {
  const FlushToZero flushToZero;
  Wave<S> wave(settings.waveSize, plan.needs);
  wave.pathCount = std::min<size_t>(settings.waveSize, area.pixels.size());
  std::vector<int64_t> splats(plan.pipeline.splats() ? 3 * area.pixels.size() : 0);
  StageCounters counters;
  StageContext<S> context;
  context.scene = &plan.scene->view;
  context.pixels = area.pixels.data();
  context.sampler = {settings.sampler, settings.seed, 0};
  context.limits = settings.limits;
  context.mis =
      misSettings(plan.pipeline.lightPass->strategies, settings, plan.scene->view.radius, area.pixels.size(), 0);
  context.light = &store;
  context.splats = {splats.data(), area.x0, area.y0, area.width, area.height};
  context.counters = &counters;
  runPass<S>(*plan.pipeline.lightPass, context, wave, nullptr);
  return store.vertices.size;
}

template <class S>
MemoryPlan plannedFor(const Scene& scene, const RenderSettings& settings) {
  const RenderPlan<S> plan = planRender<S>(scene, settings);
  const FilmArea area = filmArea(scene.film);
  const size_t pixels = area.pixels.size();
  MemoryPlan memory;
  MemoryUse& use = memory.use;
  use.scene = sceneBytes(*plan.scene);
  memory.bytesPerPath = Wave<S>(1, plan.needs).bytesPerPath();
  use.waves = settings.threads * waveBytes(memory.bytesPerPath, settings.waveSize);
  use.film = filmBytes(pixels);
  if (plan.pipeline.splats()) use.splats = settings.threads * splatBytes(pixels);
  if (!plan.pipeline.lightPass) return memory;

  LightStore<S> store(settings.waveSize, plan.needs);
  const size_t vertices = walkLightPaths(plan, settings, area, store);
  const size_t waves = (pixels + settings.waveSize - 1) / settings.waveSize;
  use.lightVertices = (plan.pipeline.photonMap ? waves : settings.threads) * store.bytes();
  if (plan.pipeline.photonMap) {
    const size_t walked = std::min<size_t>(settings.waveSize, pixels);
    use.photonMap = PhotonMap<S>::bytesFor(vertices * pixels / walked);
  }
  return memory;
}

}  // namespace

template <class S>
size_t sceneBytes(const CompiledScene<S>& scene) {
  return bytesOf(scene.primitives.records) + bytesOf(scene.primitives.attributes) + bytesOf(scene.materials) +
         bytesOf(scene.textures.records) + bytesOf(scene.textures.texels) + bytesOf(scene.lights.records) +
         bytesOf(scene.lights.table) + bytesOf(scene.lights.environment.texels) +
         bytesOf(scene.lights.environment.probability) + bytesOf(scene.lights.environment.table);
}
template size_t sceneBytes(const CompiledScene<float>&);
template size_t sceneBytes(const CompiledScene<double>&);

size_t filmBytes(size_t pixels) { return pixels * (3 * sizeof(double) + sizeof(uint32_t)); }
size_t splatBytes(size_t pixels) { return pixels * 3 * sizeof(int64_t); }
size_t waveBytes(size_t bytesPerPath, size_t waveSize) { return bytesPerPath * paddedItems(waveSize); }

MemoryPlan planMemory(const Scene& scene, const RenderSettings& settings) {
  return settings.precision == Precision::doubled ? plannedFor<double>(scene, settings)
                                                  : plannedFor<float>(scene, settings);
}

}  // namespace wavecrest
