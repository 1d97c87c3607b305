// The options of a campaign that say by which methods and settings its runs are rendered, from words: one place for the
// command line and the library.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/campaign/campaign_settings.h"

namespace wavecrest {

using CampaignWords = std::map<std::string, std::vector<std::string>>;  // by option name; only what was given

// The names of rows that --methods of a campaign takes: each method, and its variants ("ppm-direct", "vcm-auto").
std::span<const std::string_view> campaignMethodNames();

// NAME=VALUE of a scene's variables; UsageError for any other word.
std::map<std::string, std::string> parseDefinitions(const std::vector<std::string>& words);

// Fills methods, definitions, and of `render` radius, radiusAlpha, lightPaths and clock. Throws UsageError.
void chooseRows(const CampaignWords& words, const Profile& profile, CampaignSettings& settings);

// Whether the row is rendered with the sampler of --sampler. Rows "-auto" have the best of their method, and the chains
// of pssmlt draw numbers of their own, without a direct pass.
bool takesSampler(const CampaignMethod& row);

// Refuses options that no row of the settings has any use for, unless they are as by default. Throws UsageError.
void refuseUnusedWords(const CampaignWords& words, const CampaignSettings& settings);

// What the results file says of them.
void addRowKeys(const CampaignSettings& settings, std::map<std::string, std::string>& keys);

}  // namespace wavecrest
