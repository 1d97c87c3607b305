// What is kept of a run so that another process goes on with it: a checkpoint of its session, whose notes are the
// snapshots that have been measured. A run that goes on is, but for time, the run that was never broken.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "bench/checkpoint/checkpoint.h"
#include "wavecrest/results.h"

namespace wavecrest {

// The measured part of a run, as the notes of its checkpoint.
struct RunSoFar {
  std::vector<SnapshotRecord> snapshots = {};
  unsigned leftOut = 0;                  // snapshots before the first whole image
  std::vector<std::string> doubts = {};  // of earlier processes
};

nlohmann::ordered_json notesOf(const RunSoFar& run);
// Throws nlohmann::json::exception where the notes are none of a run.
RunSoFar runOfNotes(const nlohmann::ordered_json& notes);

// A run's checkpoint that another process has left; null where there is none. Throws as Checkpoint does.
std::unique_ptr<Checkpoint> keptCheckpoint(const std::filesystem::path& file);

}  // namespace wavecrest
