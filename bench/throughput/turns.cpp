#include "bench/throughput/turns.h"

#include <cassert>

namespace wavecrest {
namespace {

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

Slice renderSlice(Session& session, double seconds) {
  const RenderStatistics before = session.statistics();
  session.renderUntil(std::nullopt, before.renderSeconds + seconds);
  return difference(session.statistics(), before);
}

}  // namespace

double median(std::vector<double> values) {
  assert(!values.empty());
  std::sort(values.begin(), values.end());
  const size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

std::vector<std::vector<Slice>> renderInTurn(std::span<const std::unique_ptr<Session>> sessions, double sliceSeconds,
                                             size_t rounds, const std::function<void()>& afterRound) {
  std::vector<std::vector<Slice>> slices(sessions.size());
  for (const auto& session : sessions) renderSlice(*session, sliceSeconds);
  for (size_t round = 0; round < rounds; ++round) {
    for (size_t k = 0; k < sessions.size(); ++k) {
      const size_t i = round % 2 == 0 ? k : sessions.size() - 1 - k;
      slices[i].push_back(renderSlice(*sessions[i], sliceSeconds));
    }
    afterRound();
  }
  return slices;
}

}  // namespace wavecrest
