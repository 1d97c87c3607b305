// Makes a report's data from a folder of renders (results_folder.h): measures every snapshot of every run against its
// scene's reference, and gathers runs that differ by nothing but the seed. Seeds meet at snapshots of one number, or
// where those are of different times and iterations, at equal times.
#pragma once

#include <filesystem>

#include "bench/report/report_data.h"

namespace wavecrest {

/// path: the folder, or a list of images (other_images.h) in it. reference: of all scenes; empty: those in the folder.
/// Throws ResultsError if the folder lacks something, runs of one scene name have different scene hashes, or two have
/// the same seed and settings; ImageError if an image cannot be read or differs in size.
ConvergenceReport collectRenders(const std::filesystem::path& path, const std::filesystem::path& reference = {});

}  // namespace wavecrest
