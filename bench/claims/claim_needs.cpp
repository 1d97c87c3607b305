#include "bench/claims/claim_needs.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

#include "bench/claims/comparison.h"
#include "bench/claims/study.h"

namespace wavecrest {
namespace {

using nlohmann::json;

// The number of the study's paths is known to a factor of three (study.h), so 0.9 of what is needed is enough.
constexpr double kPathTolerance = 0.9;

// Whether a method merges paths with photons within a radius.
bool merges(const std::string& method) { return method == "ppm" || method == "bpm" || method == "vcm"; }

// All methods that a condition, or the conditions of a claim, name.
std::set<std::string> methodsOf(const Condition& condition) {
  std::set<std::string> methods(condition.methods.begin(), condition.methods.end());
  methods.insert(condition.than.begin(), condition.than.end());
  return methods;
}
std::set<std::string> methodsOf(const Claim& claim) {
  std::set<std::string> methods;
  for (const Condition& condition : claim.conditions) methods.merge(methodsOf(condition));
  return methods;
}

// The light paths that a photon search of the first iteration can meet, as a share of the study's: N_L r^2 here over
// N_L r^2 there. Nothing where the run does not say.
std::optional<double> lightPathShare(const json& stats) {
  const double iterations = stats.value("iterations", 0.0), paths = stats.value("light_paths", 0.0);
  if (!(iterations > 0)) return std::nullopt;
  // Files of earlier versions do not say the radius, which could not be chosen then.
  const double radius = stats.value("radius", kStudyRadius) / kStudyRadius;
  return paths / iterations * radius * radius / kStudyPixels;
}

// Of a method that merges a light path counts for each camera path, as in the study: with more of them an iteration
// meets more photons, but convergence goes by iterations.
std::optional<double> pathShare(const json& stats, const std::string& method, const std::string& scene) {
  const double pixels = stats.value("width", 0.0) * stats.value("height", 0.0);
  if (!(pixels > 0)) return std::nullopt;
  const double mutations = stats.value("mutations", 0.0), cameraPaths = stats.value("camera_paths", 0.0);
  const double paths = mutations > 0    ? mutations
                       : merges(method) ? 2 * cameraPaths
                                        : cameraPaths + stats.value("light_paths", 0.0);
  return paths / pixels / studyPathsPerPixel(scene);
}

// The processor of a run. Stats of earlier versions do not say it: those runs are of the campaign's first process, and
// the campaign's processors are listed with commas.
std::string processorOf(const json& stats, const CampaignResults& results) {
  const auto all = results.campaign.find("cpu");
  const std::string first = all == results.campaign.end() ? "" : all->second.substr(0, all->second.find(", "));
  return stats.value("cpu", first);
}

// What differs between the runs of these methods, in words: their time, threads or processor, as in a campaign that is
// being extended, or whose parts were rendered on different machines. Empty where all are equal.
std::string unequalRuns(const std::set<std::string>& methods, const SceneLosses& scene) {
  std::optional<double> shortest, longest;
  std::set<std::string> processors;
  std::set<uint32_t> threads;
  for (const std::string& method : methods) {
    for (const RunRecord* run : scene.runs(method)) {
      const json stats = json::parse(run->stats, nullptr, false);
      if (!stats.is_object()) continue;
      if (std::string cpu = processorOf(stats, scene.results()); !cpu.empty()) processors.insert(std::move(cpu));
      if (const auto own = stats.value("threads", 0U); own > 0) threads.insert(own);
      if (!stats.contains("asked_seconds")) continue;
      const double asked = stats["asked_seconds"];
      shortest = std::min(shortest.value_or(asked), asked);
      longest = std::max(longest.value_or(asked), asked);
    }
  }
  if (shortest != longest) {
    return fmt::format("runs of {} and of {} stand side by side", secondsText(*shortest), secondsText(*longest));
  }
  if (threads.size() > 1) {
    return fmt::format("runs of {} threads stand side by side", fmt::join(threads, " and of "));
  }
  if (processors.size() < 2) return "";
  return fmt::format("runs of two processors stand side by side: {}", fmt::join(processors, " and "));
}

// The least share over the runs of a method; nothing where none says.
template <class Share>
std::optional<double> leastShare(const SceneLosses& scene, const std::string& method, Share share) {
  std::optional<double> least;
  for (const RunRecord* run : scene.runs(method)) {
    const json stats = json::parse(run->stats, nullptr, false);
    if (!stats.is_object()) continue;
    const std::optional<double> own = share(stats);
    if (own) least = std::min(least.value_or(*own), *own);
  }
  return least;
}

// What the runs of these methods lack on a scene.
std::string unmetOn(const ClaimNeeds& needs, const std::set<std::string>& methods, const SceneLosses& scene) {
  if (std::string unequal = unequalRuns(methods, scene); !unequal.empty()) return unequal;
  for (const std::string& method : methods) {
    // Light paths: only merging methods search for photons.
    if (needs.lightPaths > 0 && merges(method)) {
      const std::optional<double> share = leastShare(scene, method, lightPathShare);
      if (share && *share < needs.lightPaths) {
        return fmt::format("a search of {} meets {:.2g} of the study's light paths; needs {:g}", scene.rowOf(method),
                           *share, needs.lightPaths);
      }
    }
    // Paths per pixel by the end of the run.
    if (needs.paths > 0) {
      const std::optional<double> share = studyPathShare(scene, method);
      if (share && *share < kPathTolerance * needs.paths) {
        return fmt::format("{} made {:.2g} of the study's paths per pixel; needs {:g}", scene.rowOf(method), *share,
                           needs.paths);
      }
    }
  }
  return "";
}

}  // namespace

std::optional<double> studyPathShare(const SceneLosses& scene, const std::string& method) {
  return leastShare(scene, method, [&](const json& stats) { return pathShare(stats, method, scene.name()); });
}

std::string pathShares(const Claim& claim, const SceneLosses& scene) {
  std::string shares;
  for (const std::string& method : methodsOf(claim)) {
    const std::optional<double> share = studyPathShare(scene, method);
    if (share) shares += fmt::format("{}{} {:.2g}", shares.empty() ? "" : ", ", scene.rowOf(method), *share);
  }
  return shares.empty() ? shares : "of the study's paths per pixel: " + shares;
}

std::string unmetNeed(const Claim& claim, const SceneLosses& scene) {
  if (std::string need = unmetOn(claim.needs, methodsOf(claim), scene); !need.empty()) return need;
  for (const Condition& condition : claim.conditions) {
    if (condition.control.empty()) continue;
    const std::string need = unmetOn(claim.needs, methodsOf(condition), scene.other(condition.control));
    if (!need.empty()) return fmt::format("in {}, the control, {}", condition.control, need);
  }
  return "";
}

}  // namespace wavecrest
