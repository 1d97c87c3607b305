#include "library/campaign_resume.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "bench/campaign/file_lock.h"
#include "bench/results/read_results.h"
#include "bench/results/results_store.h"
#include "bench/results/within_folder.h"
#include "library/campaign_options.h"
#include "library/errors.h"
#include "library/option_values.h"

namespace wavecrest {
namespace {

using api::CampaignOptions;
using Words = std::vector<std::string>;

// The words of "scenes" or "--methods"; where the option was not given, the names of what the campaign has without it.
Words listed(const CampaignOptions& options, const std::string& name) {
  if (const auto given = options.defining.find(name); given != options.defining.end()) return given->second;
  const CampaignSettings settings = campaignSettings(options);
  Words words;
  if (name == "scenes") {
    for (const CampaignScene& scene : settings.scenes) words.push_back(scene.word);
  } else {
    for (const CampaignMethod& row : settings.methods) words.push_back(row.name());
  }
  return words;
}

// Whether every run of `after` has at least the time or the iterations of the same run of `before`. Both have the same
// scenes.
bool isLonger(const CampaignOptions& before, const CampaignOptions& after) {
  const CampaignSettings a = campaignSettings(before), b = campaignSettings(after);
  if (a.iterations.has_value() != b.iterations.has_value()) return false;
  if (a.iterations) return *b.iterations >= *a.iterations;
  for (size_t i = 0; i < a.scenes.size(); ++i) {
    if (b.scenes[i].effort.seconds < a.scenes[i].effort.seconds) return false;
  }
  return true;
}

// `before` with the words of one option, if that leaves the campaign as it is or makes it larger. Otherwise nothing.
std::optional<CampaignOptions> extended(const CampaignOptions& before, const std::string& name, const Words& words) {
  CampaignOptions after = before;
  // Scenes and methods: new words are appended. Nothing is removed.
  if (name == "scenes" || name == "--methods") {
    Words all = listed(before, name);
    for (const std::string& word : words) {
      if (std::find(all.begin(), all.end(), word) == all.end()) all.push_back(word);
    }
    after.defining[name] = all;
    return after;
  }
  // Other options: the new value must ask for as much or more. Options without an order cannot change.
  after.defining[name] = words;
  // Each of these says how long runs are, so the one takes the place of the other.
  if (name == "--time") after.defining.erase("--time-factor");
  if (name == "--time-factor") after.defining.erase("--time");
  if (name == "--seeds") {
    return campaignSettings(after).seeds >= campaignSettings(before).seeds ? std::optional(after) : std::nullopt;
  }
  if (name == "--images") {
    return campaignSettings(after).keepImages == campaignSettings(before).keepImages ? std::optional(after)
                                                                                     : std::nullopt;
  }
  if (name == "--time" || name == "--time-factor" || name == "--spp")
    return isLonger(before, after) ? std::optional(after) : std::nullopt;
  // Options whose values are in the results file also where they were not given: giving the same value changes nothing.
  constexpr std::array<std::string_view, 10> kTold{"--profile",     "--size",         "--precision", "--sampler",
                                                   "--radius",      "--radius-alpha", "--roulette",  "--merge-vertices",
                                                   "--light-paths", "--clock"};
  const auto meaning = [](const CampaignOptions& one) {
    std::map<std::string, std::string> keys = campaignKeys(one, campaignSettings(one));
    keys.erase("options");
    return keys;
  };
  if (std::find(kTold.begin(), kTold.end(), name) != kTold.end() && meaning(after) == meaning(before)) return before;
  return std::nullopt;
}

// Times are about one number of threads, which is what the campaign was begun with. stored: what its results file says,
// of files of earlier versions a list. Throws UsageError for another number in a campaign by time.
void keepThreads(CampaignOptions& options, const std::string& stored, const std::filesystem::path& results) {
  const std::string latest = stored.substr(stored.rfind(' ') + 1);
  const uint32_t begun = static_cast<uint32_t>(std::strtoul(latest.c_str(), nullptr, 10));
  if (begun == 0) return;
  if (options.threads == 0) options.threads = begun;
  if (options.threads == begun || campaignSettings(options).iterations) return;
  throw UsageError(fmt::format("--threads {}: {} was begun with {}; expected the same, or another --out",
                               options.threads, results.string(), begun));
}

// A profile may choose otherwise than when the campaign began: what it chose then is asked for by name, so that all
// runs have one radius, one roulette and one kind of vcm. Files of earlier versions do not name all of them.
void keepFormerChoices(CampaignOptions& options, const std::map<std::string, std::string>& stored) {
  const CampaignSettings settings = campaignSettings(options);
  const std::map<std::string, std::string> now = campaignKeys(options, settings);
  const auto anyRow = [&](bool (*has)(Method)) {
    return std::any_of(settings.methods.begin(), settings.methods.end(),
                       [has](const CampaignMethod& row) { return has(row.method); });
  };
  const auto keep = [&](const char* option, const char* key, const char* earlier, bool used) {
    const auto found = stored.find(key);
    const std::string former = found == stored.end() ? earlier : found->second;
    if (used && now.at(key) != former) options.defining[option] = {former};
  };
  keep("--roulette", "roulette", "throughput", anyRow(hasRouletteChoice));
  keep("--radius", "radius", "0.001", anyRow(mergesPaths));
  keep("--sampler", "sampler", "independent", true);
  keep("--merge-vertices", "merge_vertices", "all", anyRow(choosesMergeVertices));
}

}  // namespace

void resumeCampaign(CampaignOptions& options, const std::filesystem::path& results) {
  // The folder may have come from others.
  withinFolder(results.parent_path(), results.filename());
  const FileLock lock(results);
  // Makes the tables where an earlier process died before it had made them.
  const ResultsStore whole(results);
  // Reads with which options the campaign began.
  const CampaignResults before = readResults(results);
  const auto stored = before.campaign.find("options");
  // Without options the earlier process died before its first run, so the campaign begins with the given ones.
  if (stored == before.campaign.end()) return;
  // Without --reference, references are in the folder that was given when the campaign began.
  const auto folder = before.campaign.find("reference_folder");
  if (options.reference.empty() && folder != before.campaign.end()) options.reference = folder->second;
  CampaignOptions all = options;
  try {
    all.defining = nlohmann::json::parse(stored->second).get<std::map<std::string, Words>>();
  } catch (const nlohmann::json::exception&) {
    throw ResultsFileError(results.string() + ": its options are none; expected an intact results file of a campaign");
  }
  const std::map<std::string, Words> begun = all.defining;
  keepFormerChoices(all, before.campaign);
  // Each option that is given again must be the same, or make the campaign larger.
  for (const auto& [name, words] : options.defining) {
    const auto known = begun.find(name);
    if (known != begun.end() && known->second == words) continue;
    const std::optional<CampaignOptions> larger = extended(all, name, words);
    if (!larger) {
      // A time and a factor take each other's place.
      const std::string other = name == "--time" ? "--time-factor" : name == "--time-factor" ? "--time" : "";
      const auto instead = begun.find(other);
      const std::string was = known != begun.end()     ? fmt::format("{}", fmt::join(known->second, " "))
                              : instead != begun.end() ? fmt::format("{} {}", other, fmt::join(instead->second, " "))
                                                       : "the default";
      throw UsageError(fmt::format("{} {}: {} was begun with {}; expected the same, more, or another --out", name,
                                   fmt::join(words, " "), results.string(), was));
    }
    const auto methods = [](const CampaignOptions& one) { return campaignSettings(one).methods; };
    if (name == "--methods" && campaignSettings(all).shard.count > 1 && methods(*larger) != methods(all)) {
      throw UsageError("--methods: shards divide scenes and methods, so none can be added; expected another --out");
    }
    all = *larger;
  }
  options.defining = all.defining;
  const auto threads = before.campaign.find("threads");
  if (threads != before.campaign.end()) keepThreads(options, threads->second, results);
}

}  // namespace wavecrest
