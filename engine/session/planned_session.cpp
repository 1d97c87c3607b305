#include "engine/session/planned_session.h"

#include <utility>

#include "engine/pilot/finished_plan.h"
#include "engine/plan/memory_plan.h"

namespace wavecrest {

namespace {

// All threads read what a plan holds, so its pages are spread over the nodes.
template <class S>
RenderPlan<S> planIn(oneapi::tbb::task_arena& arena, const Scene& scene, const RenderSettings& settings,
                     std::shared_ptr<const CompiledScene<S>> compiled, const FilmArea& area, double& seconds) {
  RenderPlan<S> plan;
  seconds = timeBuilding(
      settings, [&] { arena.execute([&] { plan = finishedPlan<S>(scene, settings, area, std::move(compiled)); }); });
  return plan;
}

}  // namespace

double timeBuilding(const RenderSettings& settings, const std::function<void()>& work) {
  const auto begin = Clock::now();
  const WorkerLimit limit(settings.threads);
  const SpreadMemory spread(settings.placement);
  work();
  return secondsSince(begin);
}

template <class S>
PlannedSession<S>::PlannedSession(const Scene& scene, const RenderSettings& settings, Prepared<S> prepared)
    : arena_(static_cast<int>(settings.threads)),
      film_(filmArea(settings.filmOf(scene))),
      settings_(withPieces(settings, settings.filmOf(scene), film_.area().pixels.size())),
      plan_(planIn<S>(arena_, scene, settings_, std::move(prepared.scene), film_.area(), buildSeconds_)),
      choice_(std::move(prepared.choice)) {
  buildSeconds_ += prepared.buildSeconds;
  if (choice_) clock_.goOnFrom(choice_->seconds, choice_->cpuSeconds);
  if (spreadsSamples(plan_, settings_)) film_.spreadBy(plan_.view.camera);
}

template <class S>
void PlannedSession<S>::finishBuilding(const std::function<void()>& rest) {
  buildSeconds_ += timeBuilding(settings_, [&] {
    rest();
    // Threads are bound last. New memory of a bound thread is on the thread's own node.
    pins_.emplace(arena_, settings_.placement);
  });
}

template <class S>
RenderStatistics PlannedSession<S>::plannedStatistics() const {
  // Times and choices of the plan, then the memory that does not depend on the schedule.
  RenderStatistics out;
  out.buildSeconds = buildSeconds_;
  out.renderSeconds = clock_.seconds();
  out.renderWallSeconds = clock_.wallSeconds();
  out.cpuSeconds = clock_.cpuSeconds();
  out.isa = plan_.isa;
  out.sampler = settings_.sampler;
  out.specialization = plan_.specialization;
  out.accel = plan_.accel();
  // Filters that cannot be spread are sampled, whatever the settings say.
  out.filterMode = film_.spreads() ? FilterMode::spread : FilterMode::sample;
  if (plan_.pipeline.has(Fold::photonMap)) out.mergeRadius = plan_.mergeRadius;
  out.choice = choice_;
  out.memory.scene = sceneBytes(*plan_.scene);
  out.memory.film = film_.bytes();
  out.memory.image = film_.imageBytes();
  return out;
}

template <class S>
void PlannedSession<S>::goOnFromEarlier(uint64_t progressPaths) {
  // Render seconds of earlier sessions are wall seconds (WorkDone::of).
  clock_.goOnFrom(earlier_.renderSeconds, earlier_.cpuSeconds);
  progressPaths_.store(progressPaths, std::memory_order_relaxed);
}

template class PlannedSession<float>;
template class PlannedSession<double>;

}  // namespace wavecrest
