#include "engine/session_state.h"

#include <string>

namespace wavecrest {

void StateWriter::bytes(std::span<const unsigned char> bytes) {
  if (waiting_.size() + bytes.size() > kBlock) flush();
  if (bytes.size() > kBlock) {
    sink_(bytes);
    return;
  }
  waiting_.insert(waiting_.end(), bytes.begin(), bytes.end());
}

void StateWriter::flush() {
  if (!waiting_.empty()) sink_(waiting_);
  waiting_.clear();
}

void StateReader::expect(uint64_t expected, const char* what) {
  const auto found = value<uint64_t>();
  if (found == expected) return;
  throw StateError("it has " + std::to_string(found) + " " + what + ", this render " + std::to_string(expected));
}

void StateReader::finish() const {
  if (!left_.empty()) throw StateError("its state goes on after its end");
}

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
  out.value(uint64_t{stages.size()});
  for (const RenderStatistics::StageRow& row : stages) {
    out.value(row.items);
    out.value(row.laneSlots);
    out.value(row.seconds);
  }
}

void WorkDone::restore(StateReader& in, std::vector<RenderStatistics::StageRow> rows) {
  paths = in.value<uint64_t>();
  lightPaths = in.value<uint64_t>();
  counters = in.value<StageCounters>();
  renderSeconds = in.value<double>();
  cpuSeconds = in.value<double>();
  stages = std::move(rows);
  in.expect(stages.size(), "stages");
  for (RenderStatistics::StageRow& row : stages) {
    row.items = in.value<uint64_t>();
    row.laneSlots = in.value<uint64_t>();
    row.seconds = in.value<double>();
  }
}

void WorkDone::addTo(RenderStatistics& statistics) const {
  statistics.paths += paths;
  statistics.lightPaths += lightPaths;
  statistics.counters += counters;
  for (size_t i = 0; i < stages.size(); ++i) {
    statistics.stages[i].items += stages[i].items;
    statistics.stages[i].laneSlots += stages[i].laneSlots;
    statistics.stages[i].seconds += stages[i].seconds;
  }
}

}  // namespace wavecrest
