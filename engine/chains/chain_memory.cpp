#include "engine/chains/chain_memory.h"

#include "engine/chains/chain_worker.h"
#include "kernels/columns/light_vertices.h"

namespace wavecrest {

template <class S>
void addChainMemory(const RenderPlan<S>& plan, const RenderSettings& settings, size_t pixels, size_t workers,
                    MemoryUse& use) {
  const ChainState::Kept kept = keptSamples(plan.pipeline, plan.scene->view, settings.limits.maxDepth);
  const size_t chains = settings.metropolis.chains, whole = chains / settings.waveSize,
               rest = chains % settings.waveSize;
  if (whole != 0) use.chains += whole * ChainState(settings.waveSize, kept).bytes();
  if (rest != 0) use.chains += ChainState(rest, kept).bytes();
  // A multiplexed walk ends at its light, or with a vertex on either side: three more waves.
  const size_t waves = plan.pipeline.lightPass ? 4 : 1;
  use.waves += workers * waves * waveBytes(Wave<S>(1, plan.needs).bytesPerPath(), settings.waveSize);
  use.splats += (workers + 1) * splatBytes(pixels);
  if (plan.pipeline.lightPass) {
    LightStore<S> store(settings.waveSize, plan.needs);
    store.beginDepth(settings.waveSize);
    use.lightVertices += workers * store.bytes();
  }
}
template void addChainMemory(const RenderPlan<float>&, const RenderSettings&, size_t, size_t, MemoryUse&);
template void addChainMemory(const RenderPlan<double>&, const RenderSettings&, size_t, size_t, MemoryUse&);

}  // namespace wavecrest
