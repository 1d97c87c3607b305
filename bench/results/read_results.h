// Reads results files: one, or the shards of a campaign that was split, as if it had been one.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "bench/results/results_error.h"
#include "wavecrest/results.h"

namespace wavecrest {

constexpr std::string_view kResultsFile = "results.sqlite";  // in a campaign's folder

// The content of a results file; a folder stands for the results file in it, or if there is none for those of the
// shards in it. Throws ResultsFileError.
CampaignResults readResults(const std::filesystem::path& path);

// Whether a folder holds a results file, or those of shards.
bool holdsResults(const std::filesystem::path& folder);

// Several files as one campaign. Throws ResultsFileError where they are not parts of the same: settings or scenes that
// differ, or a run that is in two of them. Values of the environment that differ (cpu, commit, ...) are listed. Claims
// are left out, as none of the parts could judge the whole: see bench/claims.
CampaignResults readResults(std::span<const std::filesystem::path> paths);

}  // namespace wavecrest
