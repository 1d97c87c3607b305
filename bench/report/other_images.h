// Images of other programs in a results folder, as runs: by their names, METHOD.SECONDS.exr, or by a list in CSV.
//
// A name's SECONDS is a number with or without `s` or `ms`; METHOD is what stands before it. The list is a CSV file, by
// default images.csv in the folder: an image and its render time in seconds on each line. With a line of names first,
// columns may stand in any order and be more: image, seconds, method, seed, iterations, scene. A method that no column
// names is the image's name without its number, after its folder where images of one name lie in several.
//
// Images that wavecrest rendered say by which settings: those of different settings are different runs.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "bench/report/results_folder.h"

namespace wavecrest {

/// In a folder, the name of the list.
constexpr const char* kImageList = "images.csv";

/// Runs of the images that a list names; paths are relative to its folder. Those without a scene are of `scene`. Throws
/// ResultsError for a line that cannot be read.
std::vector<RunFile> readListedRuns(const std::filesystem::path& list, const std::string& scene);

/// Runs of the images of a folder that are named METHOD.SECONDS.exr (or .pfm or .hdr), without references and without
/// what belongs to the given runs. Where there are none of those, images that wavecrest rendered without --stats say
/// themselves what they are.
std::vector<RunFile> readNamedRuns(const std::filesystem::path& folder, const std::string& scene,
                                   std::span<const RunFile> known);

}  // namespace wavecrest
