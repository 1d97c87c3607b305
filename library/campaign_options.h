// From a campaign's options, in words, to its settings, and what belongs to its beginning and its end.
#pragma once

#include <array>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "bench/campaign/campaign_settings.h"
#include "bench/report/write_report.h"
#include "wavecrest/campaign_options.h"

namespace wavecrest {

// The words of --images.
constexpr std::array<std::string_view, 2> kImageChoices{"all", "last"};

// The keys that CampaignOptions::defining may have.
std::span<const std::string_view> campaignWords();

// The campaign that these options ask for, whatever its results file holds. Throws UsageError.
CampaignSettings campaignSettings(const api::CampaignOptions& options);

// The same once its names are checked. If its results file exists, the campaign goes on: options takes from the
// file what was not given again (library/campaign_resume.h). Throws UsageError, also for a file that exists without
// options.resume.
CampaignSettings begunCampaign(api::CampaignOptions& options);

// What the results file says of the campaign besides its environment.
std::map<std::string, std::string> campaignKeys(const api::CampaignOptions& options, const CampaignSettings& settings);

// Judges the study's findings on the results, stores the verdicts with them and writes the report. For a campaign that
// is whole, not for a shard.
WrittenReport finishCampaign(const CampaignSettings& settings);

}  // namespace wavecrest
