// One run of a campaign: a scene by a method with a seed, every snapshot measured against the reference.
//
// The render clock stands still while an image is resolved, written and measured. Nothing is left to chance but time:
// with counted iterations images and values repeat to the bit.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "bench/campaign/reference_file.h"
#include "bench/campaign/session_hooks.h"
#include "engine/session/snapshots.h"
#include "metrics/prepared_reference.h"
#include "wavecrest/results.h"

namespace wavecrest {

struct RunRequest {
  const Scene& scene;
  RenderSettings settings;  // with method, seed and the end of the run
  SnapshotSchedule schedule;
  const PreparedReference& reference;
  const Reference* halves = nullptr;  // the same: to measure error without its noise, where it is given
  std::string row = {};               // under which the campaign keeps the run; empty: the method's name
  std::filesystem::path out;          // images go to its folder images
  bool keepImages = true;             // of all snapshots, else of the last
  // Checkpoint of the run, written with the first snapshot after each minute, when the run is stopped and at its end.
  // If the file exists and is of the same run, the run resumes from it. Empty: none.
  std::filesystem::path checkpoint = {};
  std::function<void(const std::string&)> say = {};  // why a checkpoint that exists is not resumed
  double loadSeconds = 0;                            // of the scene, for the record
};

// Returns the run. Its images have names of unfinished ones until placeImages(), so that those of an earlier, shorter
// run stay as they are. Returns nothing if the run was interrupted before its end; its images are then removed, unless
// there is a checkpoint to resume from. A run is refused if the method cannot render the scene, or if the time is too
// short for one whole image; the stats then have the time that was asked for (asked_seconds). Snapshots before the
// first whole image are left out and counted in the stats (snapshots_left_out). Of several that are due at once, as
// within a long iteration, only the last is taken. Stats of a timed run also list what disturbed it (doubts).
std::optional<RunRecord> measuredRun(const RunRequest& request, const SessionHooks& hooks);

// Gives the images of a run the names that its record says, out/images/SCENE.METHOD.SEED.NUMBER.exr, in place of those
// that have them. Throws std::filesystem::filesystem_error.
void placeImages(const std::filesystem::path& out, const RunRecord& run);

// All scores of all metrics that are measured by default and that the image is large enough for, by scoreName.
MetricValues measureImage(const PreparedReference& reference, const std::string& name, Image image);

}  // namespace wavecrest
