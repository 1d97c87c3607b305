#include "bench/campaign/kept_run.h"

#include <fmt/format.h>

#include <cstdlib>

namespace wavecrest {

// Scores are written as text: some are infinite, for which JSON has no number.
nlohmann::ordered_json notesOf(const RunSoFar& run) {
  nlohmann::ordered_json snapshots = nlohmann::ordered_json::array();
  for (const SnapshotRecord& one : run.snapshots) {
    nlohmann::ordered_json values = nlohmann::ordered_json::object();
    for (const auto& [name, value] : one.values) values[name] = fmt::format("{:.17g}", value);
    snapshots.push_back({{"number", one.number},
                         {"render_seconds", one.renderSeconds},
                         {"iterations", one.iterations},
                         {"file", one.file},
                         {"values", values}});
  }
  return {{"measured", snapshots}, {"snapshots_left_out", run.leftOut}, {"doubts", run.doubts}};
}

RunSoFar runOfNotes(const nlohmann::ordered_json& notes) {
  RunSoFar run{.leftOut = notes.at("snapshots_left_out").get<unsigned>(),
               .doubts = notes.at("doubts").get<std::vector<std::string>>()};
  for (const auto& one : notes.at("measured")) {
    SnapshotRecord& snapshot = run.snapshots.emplace_back();
    snapshot.number = one.at("number").get<unsigned>();
    snapshot.renderSeconds = one.at("render_seconds").get<double>();
    snapshot.iterations = one.at("iterations").get<uint64_t>();
    snapshot.file = one.at("file").get<std::string>();
    for (const auto& [name, value] : one.at("values").items()) {
      snapshot.values[name] = std::strtod(value.get<std::string>().c_str(), nullptr);
    }
  }
  return run;
}

std::unique_ptr<Checkpoint> keptCheckpoint(const std::filesystem::path& file) {
  if (file.empty() || !std::filesystem::exists(file)) return nullptr;
  return std::make_unique<Checkpoint>(file.string());
}

}  // namespace wavecrest
