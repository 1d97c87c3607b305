#include "bench/campaign/campaign_settings.h"

#include <fmt/format.h>

#include <algorithm>

#include "bench/claims/study.h"
#include "bench/results/read_results.h"

namespace wavecrest {
namespace {

// The study: 30, 60 or 120 minutes by complexity, a snapshot each 6 s in simple scenes and each 20 s in the others.
Effort paperEffort(std::string_view scene) {
  const bool simple = studyComplexity(scene) == StudyComplexity::simple;
  return {.seconds = 60 * studyMinutes(scene), .snapshotSeconds = simple ? 6.0 : 20.0};
}

// A tenth of that: 3, 6 or 12 minutes, in the study's proportions 1 : 2 : 4. Snapshots are close together at first,
// where curves are steep, and a 24th of the run apart later.
Effort studyEffort(std::string_view scene) {
  const double seconds = 6 * studyMinutes(scene);
  return {.seconds = seconds, .snapshotSeconds = seconds / 24, .logarithmicFirst = true};
}

// Light paths of an iteration in the study: as many as its images have pixels.
constexpr uint64_t kStudyLightPaths = 1024 * 768;

// Snapshots without an interval are at render times of a fixed ratio.
constexpr std::array kProfiles{
    Profile{.name = "quick",
            .description = "a first look: some ten minutes for the nine scenes",
            .size = {256, 192},
            .seeds = 2,
            .ownReferences = false,
            .lightPaths = 0,
            .studyRows = false,
            .radius = {},
            .roulette = Roulette::efficiency,
            .mergeVertices = MergeVertices::first,
            .sampler = {},
            .balancedWalks = true,
            .effort = [](std::string_view) { return Effort{.seconds = 3.5}; }},
    Profile{.name = "standard",
            .description = "small images with error bands: an hour or two",
            .size = {256, 192},
            .seeds = 3,
            .ownReferences = false,
            .lightPaths = kStudyLightPaths,
            .studyRows = true,
            .radius = kStudyRadius,
            .roulette = Roulette::throughput,
            .mergeVertices = MergeVertices::all,
            .sampler = SamplerKind::independent,
            .balancedWalks = false,
            .effort = [](std::string_view) { return Effort{.seconds = 30}; }},
    Profile{.name = "study",
            .description = "the study's size, light paths and radius in a tenth of its time: ten hours a seed",
            .size = {1024, 768},
            .seeds = 1,
            .ownReferences = true,
            .lightPaths = kStudyLightPaths,
            .studyRows = true,
            .radius = kStudyRadius,
            .roulette = Roulette::throughput,
            .mergeVertices = MergeVertices::all,
            .sampler = SamplerKind::independent,
            .balancedWalks = false,
            .effort = studyEffort},
    Profile{.name = "paper",
            .description = "the protocol of the study: 1024x768, 30 to 120 minutes a run",
            .size = {1024, 768},
            .seeds = 1,
            .ownReferences = true,
            .lightPaths = kStudyLightPaths,
            .studyRows = true,
            .radius = kStudyRadius,
            .roulette = Roulette::throughput,
            .mergeVertices = MergeVertices::all,
            .sampler = SamplerKind::independent,
            .balancedWalks = false,
            .effort = paperEffort},
};

}  // namespace

std::span<const Profile> profiles() { return kProfiles; }

const Profile* findProfile(std::string_view name) {
  // Null for a name that no profile has.
  const auto found = std::find_if(kProfiles.begin(), kProfiles.end(), [&](const Profile& p) { return p.name == name; });
  return found == kProfiles.end() ? nullptr : &*found;
}

std::string CampaignMethod::name() const {
  std::string name(toString(method));
  // The default variant, mmlt, is plain "mlt".
  if (method == Method::mlt && variant != MetropolisVariant::mmlt) {
    name += "-" + std::string(kMetropolisVariantNames[static_cast<size_t>(variant)]);
  }
  return directPass ? name + "-direct" : name;
}

std::vector<CampaignMethod> rowsOf(Method method, std::span<const MetropolisVariant> variants, DirectPass directPass) {
  std::vector<CampaignMethod> rows;
  // A row for each variant of mlt; a row with and one without the direct pass of ppm; one row for others.
  if (method == Method::mlt) {
    for (const MetropolisVariant variant : variants) rows.push_back({.method = method, .variant = variant});
  } else if (method == Method::ppm) {
    if (directPass != DirectPass::only) rows.push_back({.method = method});
    if (directPass != DirectPass::no) rows.push_back({.method = method, .directPass = true});
  } else {
    rows.push_back({.method = method});
  }
  return rows;
}

std::filesystem::path resultsFile(const CampaignSettings& settings) {
  // Each shard has a file of its own, so several processes can work in one folder.
  if (settings.shard.count == 1) return settings.out / kResultsFile;
  return settings.out / fmt::format("results.{}-of-{}.sqlite", settings.shard.index, settings.shard.count);
}

}  // namespace wavecrest
