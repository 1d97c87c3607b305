// Snapshots as JSON, for the notes of a checkpoint: those taken of a render that another process resumes.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "wavecrest/results.h"

namespace wavecrest {

// A row for each snapshot: number, render seconds, iterations, file, and the scores if it has been measured.
nlohmann::ordered_json snapshotNotes(std::span<const SnapshotRecord> snapshots);
// Throws nlohmann::json::exception where the rows are of another form.
std::vector<SnapshotRecord> snapshotsOfNotes(const nlohmann::ordered_json& rows);

}  // namespace wavecrest
