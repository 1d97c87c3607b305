// A campaign that goes on: what its results file says that it is, and options that make it larger.
#pragma once

#include <filesystem>

#include "wavecrest/campaign_options.h"

namespace wavecrest {

// Takes from an earlier process of the same campaign what options.defining does not say, and lets it say more: further
// scenes or methods, more seeds, time or iterations. Throws UsageError where it says something else, FileLockError
// while another process writes the file.
void resumeCampaign(api::CampaignOptions& options, const std::filesystem::path& results);

}  // namespace wavecrest
