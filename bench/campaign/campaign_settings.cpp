#include "bench/campaign/campaign_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "bench/claims/study.h"
#include "bench/results/read_results.h"

namespace wavecrest {
namespace {

// The study: 30, 60 or 120 minutes by complexity, a snapshot each 6 s in simple scenes and each 20 s in the others.
Effort paperEffort(std::string_view scene) {
  const bool simple = studyComplexity(scene) == StudyComplexity::simple;
  return {.seconds = 60 * studyMinutes(scene), .snapshotSeconds = simple ? 6.0 : 20.0};
}

// Minutes of a run by the paths that findings need (bench/claims), as runs are compared with the study by paths: at a
// factor of 0.3 every method that a finding names has enough of them on two threads of an AMD EPYC Zen 4. From 24
// minutes on they are estimated for an Intel Xeon Ice Lake, which is slower, and those of dragon-caustics-glossy for an
// AMD EPYC Zen 5, on which an iteration takes a third of the time. Scenes of others have those of cornell-spheres.
constexpr std::pair<std::string_view, double> kMinutesForPaths[] = {
    {"cornell-diffuse", 6}, {"cornell-mirror", 6},   {"cornell-glossy", 6},          {"lafortune-room", 29},
    {"pool-interior", 24},  {"dragon-caustics", 40}, {"dragon-caustics-glossy", 16}, {"veach-door", 53}};
constexpr double kMinutesOfOthers = 12;

// Snapshots are close together at first, where curves are steep, and a 24th of the run apart later.
Effort studyEffort(std::string_view scene) {
  const auto* const found = std::ranges::find(kMinutesForPaths, scene, &std::pair<std::string_view, double>::first);
  const double seconds = 60 * (found == std::end(kMinutesForPaths) ? kMinutesOfOthers : found->second);
  return {.seconds = seconds, .snapshotSeconds = seconds / 24, .logarithmicFirst = true};
}

// Light paths of an iteration in the study: as many as its images have pixels.
constexpr uint64_t kStudyLightPaths = 1024 * 768;

constexpr CampaignMethod rowOf(Method method) { return {.method = method}; }
constexpr CampaignMethod automatic(Method method) { return {.method = method, .automatic = true}; }
constexpr CampaignMethod kPathSpace{.method = Method::mlt, .variant = MetropolisVariant::pathspace};

// The methods of the study, which is ambiguous about mlt and the direct light of ppm; and bpm, which it does not have.
constexpr std::array kStandardRows{rowOf(Method::pt),
                                   rowOf(Method::lt),
                                   rowOf(Method::bpt),
                                   kPathSpace,
                                   rowOf(Method::mlt),
                                   rowOf(Method::ppm),
                                   CampaignMethod{.method = Method::ppm, .directPass = true},
                                   rowOf(Method::bpm),
                                   rowOf(Method::vcm)};
// The study's methods with its settings, then today's best methods, with default settings where the two differ.
constexpr std::array kStudyRows{rowOf(Method::pt),      rowOf(Method::lt),
                                rowOf(Method::bpt),     kPathSpace,
                                rowOf(Method::ppm),     CampaignMethod{.method = Method::ppm, .directPass = true},
                                rowOf(Method::vcm),     automatic(Method::ppm),
                                automatic(Method::bpm), automatic(Method::vcm),
                                rowOf(Method::mlt),     automatic(Method::gpt),
                                automatic(Method::evcm)};

// Snapshots without an interval are at render times of a fixed ratio.
constexpr std::array kProfiles{
    Profile{.name = "quick",
            .size = {256, 192},
            .seeds = 2,
            .rows = {},
            .lightPaths = 0,
            .radius = {},
            .roulette = Roulette::efficiency,
            .mergeVertices = MergeVertices::first,
            .sampler = {},
            .balancedWalks = true,
            .effort = [](std::string_view) { return Effort{.seconds = 3.5}; }},
    Profile{.name = "standard",
            .size = {256, 192},
            .seeds = 3,
            .rows = kStandardRows,
            .lightPaths = kStudyLightPaths,
            .radius = kStudyRadius,
            .roulette = Roulette::throughput,
            .mergeVertices = MergeVertices::all,
            .sampler = SamplerKind::independent,
            .balancedWalks = false,
            .effort = [](std::string_view) { return Effort{.seconds = 30}; }},
    Profile{.name = "study",
            .size = {1024, 768},
            .seeds = 1,
            .rows = kStudyRows,
            .lightPaths = kStudyLightPaths,
            .radius = kStudyRadius,
            .roulette = Roulette::throughput,
            .mergeVertices = MergeVertices::all,
            .sampler = SamplerKind::independent,
            .balancedWalks = false,
            .effort = studyEffort},
    Profile{.name = "paper",
            .size = {1024, 768},
            .seeds = 1,
            .rows = kStudyRows,
            .lightPaths = kStudyLightPaths,
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
  if (directPass) name += "-direct";
  return automatic ? name + "-auto" : name;
}

std::filesystem::path resultsFile(const CampaignSettings& settings) {
  // Each shard has a file of its own, so several processes can work in one folder.
  if (settings.shard.count == 1) return settings.out / kResultsFile;
  return settings.out / fmt::format("results.{}-of-{}.sqlite", settings.shard.index, settings.shard.count);
}

std::filesystem::path checkpointFile(const CampaignSettings& settings, const CampaignScene& scene,
                                     const CampaignMethod& row, uint64_t seed) {
  if (!settings.checkpoints) return {};
  return settings.out / "checkpoints" / fmt::format("{}.{}.{}.checkpoint", scene.name, row.name(), seed);
}

}  // namespace wavecrest
