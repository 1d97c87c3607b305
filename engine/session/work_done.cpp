#include "engine/session/work_done.h"

#include <utility>

namespace wavecrest {

// renderSeconds is wall time whatever the clock of the settings: with the CPU seconds, a session that goes on from here
// counts by either (RenderClock).
WorkDone WorkDone::of(const RenderStatistics& statistics) {
  return {.paths = statistics.paths,
          .lightPaths = statistics.lightPaths,
          .counters = statistics.counters,
          .renderSeconds = statistics.renderWallSeconds,
          .cpuSeconds = statistics.cpuSeconds,
          .stages = statistics.stages};
}

void WorkDone::save(StateWriter& out) const {
  static_assert(sizeof(StageCounters) == 11 * sizeof(uint64_t), "padding would be written");
  out.value(paths);
  out.value(lightPaths);
  out.value(counters);
  out.value(renderSeconds);
  out.value(cpuSeconds);
  // Names of stages follow from the plan and are not saved.
  out.value(uint64_t{stages.size()});
  for (const RenderStatistics::StageRow& row : stages) {
    out.value(row.items);
    out.value(row.laneSlots);
    out.value(row.seconds);
  }
}

void WorkDone::restore(StateReader& in, std::vector<RenderStatistics::StageRow> rows) {
  restore(in);
  // Stages are saved by position, without names: both sessions have the same rows.
  if (stages.size() != rows.size()) throw StateError("it has other stages than this render");
  for (size_t i = 0; i < rows.size(); ++i) stages[i].name = std::move(rows[i].name);
}

void WorkDone::restore(StateReader& in) {
  constexpr uint64_t kMostStages = 1000;
  paths = in.value<uint64_t>();
  lightPaths = in.value<uint64_t>();
  counters = in.value<StageCounters>();
  renderSeconds = in.value<double>();
  cpuSeconds = in.value<double>();
  const auto count = in.value<uint64_t>();
  if (count > kMostStages) throw StateError("it has other stages than any render");
  stages.resize(count);
  for (RenderStatistics::StageRow& row : stages) {
    row.items = in.value<uint64_t>();
    row.laneSlots = in.value<uint64_t>();
    row.seconds = in.value<double>();
  }
}

WorkDone& WorkDone::operator+=(const WorkDone& other) {
  if (stages.size() != other.stages.size()) throw StateError("it has other stages");
  paths += other.paths;
  lightPaths += other.lightPaths;
  counters += other.counters;
  renderSeconds += other.renderSeconds;
  cpuSeconds += other.cpuSeconds;
  for (size_t i = 0; i < stages.size(); ++i) {
    stages[i].items += other.stages[i].items;
    stages[i].laneSlots += other.stages[i].laneSlots;
    stages[i].seconds += other.stages[i].seconds;
  }
  return *this;
}

void WorkDone::addTo(RenderStatistics& statistics) const {
  statistics.paths += paths;
  statistics.lightPaths += lightPaths;
  statistics.counters += counters;
  // Without an earlier session there are no stages to add.
  for (size_t i = 0; i < stages.size(); ++i) {
    statistics.stages[i].items += stages[i].items;
    statistics.stages[i].laneSlots += stages[i].laneSlots;
    statistics.stages[i].seconds += stages[i].seconds;
  }
}

}  // namespace wavecrest
