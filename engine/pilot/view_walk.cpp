#include "engine/pilot/view_walk.h"

#include "engine/tasks/flush_to_zero.h"
#include "engine/walks/run_walk.h"

namespace wavecrest {

template <class S>
void walkViews(const RenderPlan<S>& plan, const RenderSettings& settings, std::span<const uint32_t> pixels,
               uint64_t seed, const CellTreeView* cells, const ViewLook<S>& look, const ViewLeft<S>& left) {
  const FlushToZero flushToZero;
  const SceneView<S>& view = plan.view;
  using enum StageId;
  const MethodPage page{{walk(Walk::camera, generateCameraPaths, {extend, arrive, findCells, scatter})}};
  const Pass<S> pass = makePipeline(page, *plan.stages, chooseIntersector(*plan.stages, *plan.scene)).cameraPass();
  StageCounters counters;
  StageContext<S> context{.scene = &view,
                          .pixels = pixels.data(),
                          .sampler = {SamplerKind::independent, seed, 0},
                          .limits = settings.limits,
                          .mis = misSettings(pass.strategies, plan.mergeRadius, 1, 0),
                          .film = {.x0 = 0, .y0 = 0, .width = view.camera.width, .height = view.camera.height},
                          .counters = &counters,
                          .learned = {.cells = cells}};
  Wave<S> wave(pixels.size(), plan.needs);
  wave.pathCount = pixels.size();
  // Depth by depth, as runPass does.
  runStage<S>(pass.generate, context, wave, nullptr);
  if (!look(wave, 0)) return;
  for (context.depth = 1; context.depth <= context.limits.maxDepth && wave.rays.size != 0; ++context.depth) {
    for (size_t stage = 0; stage < pass.perDepth.size(); ++stage) {
      if (stage + 1 == pass.perDepth.size() && !look(wave, context.depth)) return;
      runStage<S>(pass.perDepth[stage], context, wave, nullptr);
    }
    if (left) left(wave);
  }
}
template void walkViews(const RenderPlan<float>&, const RenderSettings&, std::span<const uint32_t>, uint64_t,
                        const CellTreeView*, const ViewLook<float>&, const ViewLeft<float>&);
template void walkViews(const RenderPlan<double>&, const RenderSettings&, std::span<const uint32_t>, uint64_t,
                        const CellTreeView*, const ViewLook<double>&, const ViewLeft<double>&);

}  // namespace wavecrest
