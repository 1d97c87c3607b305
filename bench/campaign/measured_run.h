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
  // The state of the run, kept there every minute or so, when it is stopped and at its end; where the file is one of
  // the same run, the run goes on from it. Empty: no state is kept.
  std::filesystem::path checkpoint = {};
  std::function<void(const std::string&)> say = {};  // why it does not go on from a state that there is
  double loadSeconds = 0;                            // of the scene, for the record
};

// The run, whose images are named as unfinished ones until placeImages(): what an earlier, shorter run has stays as it
// is. Nothing if the run was interrupted; then its images are removed, unless its state is kept. A method that cannot
// render the scene gives a run that is refused, and so does a time that is too short for one whole image; then its
// stats say which time. Snapshots before the first whole image are left out, and the stats say how many
// (snapshots_left_out). Those of a timed run also say what disturbed it (doubts).
std::optional<RunRecord> measuredRun(const RunRequest& request, const SessionHooks& hooks);

// Gives the images of a run the names that its record says, out/images/SCENE.METHOD.SEED.NUMBER.exr, in place of those
// that have them. Throws std::filesystem::filesystem_error.
void placeImages(const std::filesystem::path& out, const RunRecord& run);

// All scores of all metrics that are measured by default and that the image is large enough for, by scoreName.
MetricValues measureImage(const PreparedReference& reference, const std::string& name, Image image);

}  // namespace wavecrest
