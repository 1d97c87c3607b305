#include "bench/results/snapshot_notes.h"

#include <fmt/format.h>

#include "bench/whole_number.h"

namespace wavecrest {

nlohmann::ordered_json snapshotNotes(std::span<const SnapshotRecord> snapshots) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const SnapshotRecord& one : snapshots) {
    rows.push_back({one.number, one.renderSeconds, one.iterations, one.file});
    if (one.values.empty()) continue;
    // Scores are written as text: some are infinite, for which JSON has no number.
    nlohmann::ordered_json values = nlohmann::ordered_json::object();
    for (const auto& [name, value] : one.values) values[name] = fmt::format("{:.17g}", value);
    rows.back().push_back(values);
  }
  return rows;
}

std::vector<SnapshotRecord> snapshotsOfNotes(const nlohmann::ordered_json& rows) {
  std::vector<SnapshotRecord> snapshots;
  snapshots.reserve(rows.size());
  for (const auto& row : rows) {
    SnapshotRecord& one = snapshots.emplace_back();
    one.number = row.at(0).get<unsigned>();
    one.renderSeconds = row.at(1).get<double>();
    one.iterations = row.at(2).get<uint64_t>();
    one.file = row.at(3).get<std::string>();
    if (row.size() <= 4) continue;
    for (const auto& [name, value] : row.at(4).items()) {
      one.values[name] = wholeNumber<double>(value.get<std::string>()).value_or(0);
    }
  }
  return snapshots;
}

}  // namespace wavecrest
