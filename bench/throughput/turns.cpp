#include "bench/throughput/turns.h"

namespace wavecrest {
namespace {

constexpr double kMostOvershoot = 1.25;  // of a slice's paths over those asked for

// What a session did between two of its statistics. A slice keeps only the ray counters.
Slice difference(const RenderStatistics& after, const RenderStatistics& before) {
  Slice slice;
  slice.seconds = after.renderSeconds - before.renderSeconds;
  slice.cpuSeconds = after.cpuSeconds - before.cpuSeconds;
  slice.paths = after.paths - before.paths;
  slice.counters.raysClosest = after.counters.raysClosest - before.counters.raysClosest;
  slice.counters.raysShadow = after.counters.raysShadow - before.counters.raysShadow;
  slice.stages = after.stages;
  for (size_t i = 0; i < slice.stages.size(); ++i) {
    slice.stages[i].items -= before.stages[i].items;
    slice.stages[i].laneSlots -= before.stages[i].laneSlots;
    slice.stages[i].seconds -= before.stages[i].seconds;
  }
  return slice;
}

}  // namespace

void SliceRenderer::fill(double sliceSeconds) {
  render();
  for (;; iterations_ *= 2) {
    const Slice slice = render();
    // A whole iteration is one path per pixel. Chains render whole steps of many mutations: a slice that is too short
    // has no paths, or many more than were asked for.
    const double asked = static_cast<double>(iterations_ * session_.film().area().pixels.size());
    const bool even = slice.paths > 0 && static_cast<double>(slice.paths) <= kMostOvershoot * asked;
    if (even && slice.seconds >= 0.5 * sliceSeconds) return;
  }
}

Slice SliceRenderer::render() {
  const RenderStatistics before = session_.statistics();
  // renderUntil counts iterations from the beginning of the session.
  done_ += iterations_;
  session_.renderUntil(done_, std::nullopt);
  return difference(session_.statistics(), before);
}

std::vector<std::vector<Slice>> renderInTurn(std::span<SliceRenderer> renderers, const TurnPlan& plan,
                                             const std::function<void()>& afterRound) {
  std::vector<std::vector<Slice>> slices(renderers.size());
  double spent = 0;
  for (size_t round = 0; round < plan.mostRounds; ++round) {
    if (round >= plan.fewestRounds && spent >= plan.seconds) break;
    for (size_t k = 0; k < renderers.size(); ++k) {
      // Forwards in even rounds, backwards in odd ones.
      const size_t i = round % 2 == 0 ? k : renderers.size() - 1 - k;
      slices[i].push_back(renderers[i].render());
      spent += slices[i].back().seconds;
    }
    afterRound();
  }
  return slices;
}

std::vector<std::vector<Slice>> renderInTurn(std::span<const std::unique_ptr<Session>> sessions, const TurnPlan& plan,
                                             const std::function<void()>& afterRound) {
  // One more slice for finding out how long slices take.
  const double sliceSeconds = plan.seconds / static_cast<double>((plan.mostRounds + 1) * sessions.size());
  std::vector<SliceRenderer> renderers;
  for (const auto& session : sessions) {
    renderers.emplace_back(*session);
    renderers.back().fill(sliceSeconds);
  }
  return renderInTurn(renderers, plan, afterRound);
}

}  // namespace wavecrest
