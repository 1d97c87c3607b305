#include "bench/campaign/campaign_settings.h"

#include <fmt/format.h>

#include <algorithm>

#include "bench/results/read_results.h"

namespace wavecrest {
namespace {

// The study: 30, 60 or 120 minutes by complexity, a snapshot each 6 s in simple scenes and each 20 s in the others.
Effort studyEffort(std::string_view scene) {
  constexpr std::string_view kSimple[] = {"cornell-diffuse", "cornell-mirror", "cornell-glossy"};
  constexpr std::string_view kComplex[] = {"dragon-caustics", "dragon-caustics-glossy", "veach-door"};
  const auto in = [&](const auto& list) {
    return std::find(std::begin(list), std::end(list), scene) != std::end(list);
  };
  constexpr double kMinute = 60;
  if (in(kSimple)) return {.seconds = 30 * kMinute, .snapshotSeconds = 6};
  return {.seconds = (in(kComplex) ? 120 : 60) * kMinute, .snapshotSeconds = 20};
}

constexpr std::array kProfiles{
    Profile{.name = "quick",
            .description = "a first look: some ten minutes for the nine scenes",
            .size = {256, 192},
            .seeds = 2,
            .ownReferences = false,
            .effort = [](std::string_view) { return Effort{.seconds = 4}; }},
    Profile{.name = "standard",
            .description = "small images with error bands: an hour or two",
            .size = {256, 192},
            .seeds = 3,
            .ownReferences = false,
            .effort = [](std::string_view) { return Effort{.seconds = 30}; }},
    Profile{.name = "paper",
            .description = "the protocol of the study: 1024x768, 30 to 120 minutes a run",
            .size = {1024, 768},
            .seeds = 1,
            .ownReferences = true,
            .effort = studyEffort},
};

}  // namespace

std::span<const Profile> profiles() { return kProfiles; }

const Profile* findProfile(std::string_view name) {
  const auto found = std::find_if(kProfiles.begin(), kProfiles.end(), [&](const Profile& p) { return p.name == name; });
  return found == kProfiles.end() ? nullptr : &*found;
}

std::filesystem::path resultsFile(const CampaignSettings& settings) {
  if (settings.shard.count == 1) return settings.out / kResultsFile;
  return settings.out / fmt::format("results.{}-of-{}.sqlite", settings.shard.index, settings.shard.count);
}

}  // namespace wavecrest
