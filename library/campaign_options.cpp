#include "library/campaign_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <set>

#include "bench/claims/judge_claims.h"
#include "bench/json_text.h"
#include "bench/report/picture_crop.h"
#include "bench/results/read_results.h"
#include "bench/results/results_store.h"
#include "bench/whole_number.h"
#include "engine/load/input_file.h"
#include "engine/tasks/processors.h"
#include "library/campaign_resume.h"
#include "library/campaign_rows.h"
#include "library/errors.h"
#include "library/option_values.h"
#include "scenes/scene_list.h"

namespace wavecrest {
namespace {

namespace fs = std::filesystem;
using api::CampaignOptions;
using nlohmann::json;

// The options that say what a campaign is. They are stored in its results file; all others may change from one process
// to the next.
constexpr std::array<std::string_view, 22> kDefiningOptions{
    "scenes",        "--profile",  "--time-factor", "--time",         "--snapshot-every",
    "--spp",         "--seeds",    "--precision",   "--sampler",      "--size",
    "--images",      "--methods",  "--radius",      "--radius-alpha", "--merge-vertices",
    "--light-paths", "--roulette", "--direct-pass", "--mlt",          "--clock",
    "--crop",        "-D"};

// Those that take several words.
constexpr std::array<std::string_view, 5> kListOptions{"scenes", "--methods", "--mlt", "--crop", "-D"};

bool has(const CampaignOptions& options, const char* name) { return options.defining.contains(name); }

// The word of an option that takes one, or `otherwise` where the option was not given.
std::string get(const CampaignOptions& options, const char* name, const std::string& otherwise = "") {
  const auto found = options.defining.find(name);
  return found == options.defining.end() || found->second.empty() ? otherwise : found->second.front();
}

// ---- from words to settings -----------------------------------------------------------------------------------------

// A whole number from 1 on, or 0 for any other text.
uint32_t countOf(std::string_view text) { return wholeNumber<uint32_t>(text).value_or(0); }

// A whole number from 1 on, or UsageError.
uint32_t parseCount(const char* option, const std::string& text) {
  const uint32_t count = countOf(text);
  if (count == 0) throw UsageError(fmt::format("{} {}: expected a whole number from 1 on", option, text));
  return count;
}

// "i/n" with i from 1 to n, or UsageError.
Shard parseShard(const std::string& text) {
  const auto [index, count] = parsePart("--shard", text);
  return {index, count};
}

// The profile that was named; by default quick.
const Profile& chosenProfile(const CampaignOptions& options) {
  std::vector<std::string_view> names;
  for (const Profile& profile : profiles()) names.push_back(profile.name);
  return profiles()[parseChoice("--profile", get(options, "--profile", "quick"), names)];
}

// Run time and snapshot interval of a scene: the profile's, the time scaled by --time-factor, or those of --time and
// --snapshot-every. A longer run has the snapshots of a shorter one, and further ones.
Effort effortOf(const CampaignOptions& options, const Profile& profile, std::string_view scene) {
  Effort effort = profile.effort(scene);
  if (has(options, "--time-factor")) {
    const double factor = parseNumber("--time-factor", get(options, "--time-factor"), kTimeFactorRange);
    effort.seconds *= factor;
  }
  if (has(options, "--time")) effort.seconds = parseDuration("--time", get(options, "--time"));
  if (has(options, "--snapshot-every")) {
    const std::string every = get(options, "--snapshot-every");
    effort.snapshotSeconds = every == "log" ? 0 : parseSnapshotInterval("--snapshot-every", every);
    effort.logarithmicFirst = false;
  }
  return effort;
}

// The scenes of a campaign that names none: the nine, without those whose model has not been fetched and is not
// replaced by -D. leftOut: a line about those.
std::vector<std::string> scenesByDefault(const CampaignOptions& options, std::string& leftOut) {
  const auto defines = options.defining.find("-D");
  const bool ownDragon = defines != options.defining.end() &&
                         std::any_of(defines->second.begin(), defines->second.end(),
                                     [](const std::string& word) { return word.starts_with("dragon="); });
  std::vector<std::string> scenes, without;
  fs::path missing;
  for (const SceneEntry& entry : builtInScenes()) {
    const fs::path file = sceneFolder() / entry.fetched;
    const bool there = ownDragon || fs::exists(file);
    (there ? scenes : without).emplace_back(entry.name);
    if (!there) missing = file;
  }
  if (!without.empty()) {
    leftOut = fmt::format("without {}: there is no {}; {}", fmt::join(without, " and "), missing.filename().string(),
                          missingAssetHint(missing));
  }
  return scenes;
}

// The scenes that were named, or those by default. Results, images and references go by the stem of the file, so no two
// scenes may share one.
std::vector<CampaignScene> chosenScenes(const CampaignOptions& options, const Profile& profile, std::string& leftOut) {
  const std::vector<std::string> words =
      has(options, "scenes") ? options.defining.at("scenes") : scenesByDefault(options, leftOut);
  std::vector<CampaignScene> scenes;
  std::set<std::string> names;
  for (const std::string& word : words) {
    const fs::path file = findScene(word);
    const std::string name = word == kStandardInput ? "stdin" : file.stem().string();
    if (!names.insert(name).second) throw UsageError(fmt::format("{}: a second scene of the name '{}'", word, name));
    scenes.push_back({.name = name, .word = word, .file = file, .effort = effortOf(options, profile, name)});
  }
  return scenes;
}

// Refuses crops of other scenes than the campaign's, and crops that reach out of its images. Throws UsageError.
void checkCrops(const CampaignOptions& options, const CampaignSettings& settings) {
  if (!has(options, "--crop")) return;
  for (const std::string& word : options.defining.at("--crop")) {
    const std::optional<SceneCrop> crop = parseSceneCrop(word);
    if (!crop) {
      throw UsageError(fmt::format("--crop {}: expected SCENE:X,Y,WIDTHxHEIGHT in pixels from the top left", word));
    }
    const auto isScene = [&](const CampaignScene& one) { return one.name == crop->scene; };
    if (std::ranges::none_of(settings.scenes, isScene)) {
      throw UsageError(fmt::format("--crop {}: the campaign has no such scene; expected one of its own", word));
    }
    if (!crop->crop.liesIn(settings.size[0], settings.size[1])) {
      throw UsageError(fmt::format("--crop {}: images have {}x{} pixels; expected a part of them", word,
                                   settings.size[0], settings.size[1]));
    }
  }
}

// Settings that all runs share. Method, seed, path limits and the end come with each run.
RenderSettings renderSettings(const CampaignOptions& options) {
  RenderSettings render;
  if (options.threads != 0) requireInRange("--threads", options.threads, kThreadRange);
  render.threads = threadsOrAll(options.threads);
  render.isa = parseIsaOption(options.isa);
  render.precision =
      static_cast<Precision>(parseChoice("--precision", get(options, "--precision", "float"), kPrecisionNames));
  return render;
}

}  // namespace

namespace {

// The folder of references that come with the scenes. It holds those of 256x192 itself, and those of some other sizes
// in folders of their own.
fs::path sceneReferences(const std::array<uint32_t, 2>& size) {
  const fs::path folder = sceneFolder() / "references", own = folder / fmt::format("{}x{}", size[0], size[1]);
  return fs::is_directory(own) ? own : folder;
}

}  // namespace

CampaignSettings campaignSettings(const CampaignOptions& options) {
  // Scenes, seeds and the end of each run.
  const Profile& profile = chosenProfile(options);
  CampaignSettings settings;
  settings.scenes = chosenScenes(options, profile, settings.leftOut);
  settings.seeds = profile.seeds;
  if (has(options, "--seeds")) settings.seeds = parseCount("--seeds", get(options, "--seeds"));
  if (has(options, "--spp")) settings.iterations = parseCount("--spp", get(options, "--spp"));
  // Options that contradict each other.
  if (settings.iterations && (has(options, "--time") || get(options, "--snapshot-every", "log") != "log")) {
    throw UsageError(
        "--spp counts iterations and takes snapshots after 1, 2, 4, ...; expected no --time or "
        "--snapshot-every beside it");
  }
  if (has(options, "--time-factor") && (has(options, "--time") || settings.iterations)) {
    throw UsageError("--time-factor multiplies the profile's run times; expected no --time or --spp beside it");
  }
  // Film size, settings and methods of all runs.
  settings.size = has(options, "--size") ? parseSize("--size", get(options, "--size")) : profile.size;
  settings.render = renderSettings(options);
  settings.sampler = profile.sampler;
  if (has(options, "--sampler")) settings.sampler = parseSamplerOrAuto("--sampler", get(options, "--sampler"));
  chooseRows(options.defining, profile, settings);
  // Files: outputs, images to keep, and references.
  settings.out = options.out;
  settings.shard = parseShard(options.shard);
  settings.checkpoints = options.checkpoints;
  settings.keepImages = parseChoice("--images", get(options, "--images", "all"), kImageChoices) == 0;
  settings.referenceRequired = !options.reference.empty();
  settings.referenceFolder = options.reference.empty() ? sceneReferences(settings.size) : fs::path(options.reference);
  // --check needs all runs of a campaign by time.
  if (options.check && settings.iterations) {
    throw UsageError("--check: the study's findings are about equal time; expected no --spp beside it");
  }
  if (options.check && settings.shard.count > 1) {
    throw UsageError(
        "--check needs all methods of a scene; expected no --shard beside it, but `wavecrest report --check` once "
        "all shards are done");
  }
  return settings;
}

namespace {

// ---- what the results file says of it -------------------------------------------------------------------------------

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

// One value if it is the same for all scenes, else SCENE=VALUE of each.
template <class Value>
std::string perScene(const CampaignSettings& settings, Value value) {
  std::vector<std::string> all;
  std::set<std::string> values;
  for (const CampaignScene& scene : settings.scenes) {
    values.insert(value(scene));
    all.push_back(scene.name + "=" + value(scene));
  }
  return values.size() == 1 ? *values.begin() : joined(all);
}

}  // namespace

std::map<std::string, std::string> campaignKeys(const CampaignOptions& options, const CampaignSettings& settings) {
  // "options" holds the options as given, from which --resume goes on, and the scenes, as those by default may be
  // others by then. The other keys are for readers.
  auto defining = options.defining;
  std::vector<std::string>& words = defining["scenes"];
  words.clear();
  std::vector<std::string> scenes;
  for (const CampaignScene& scene : settings.scenes) {
    words.push_back(scene.word);
    scenes.push_back(scene.name);
  }
  std::map<std::string, std::string> keys{
      {"options", json(defining).dump()},
      {"profile", std::string(chosenProfile(options).name)},
      {"scenes", joined(scenes)},
      {"seeds", std::to_string(settings.seeds)},
      {"size", fmt::format("{}x{}", settings.size[0], settings.size[1])},
      {"precision", std::string(kPrecisionNames[static_cast<size_t>(settings.render.precision)])},
      {"sampler", settings.sampler ? std::string(toString(*settings.sampler)) : "auto"},
      {"shard", fmt::format("{}/{}", settings.shard.index, settings.shard.count)}};
  // --resume looks there again. Absolute, as it may be called from elsewhere.
  if (!options.reference.empty())
    keys["reference_folder"] = fs::absolute(options.reference).lexically_normal().string();
  addRowKeys(settings, keys);
  // The end of each run and its snapshots.
  if (settings.iterations) {
    keys["spp"] = std::to_string(*settings.iterations);
    keys["snapshots"] = "doubling";
  } else {
    keys["time"] = perScene(settings, [](const CampaignScene& s) { return fmt::format("{:g}", s.effort.seconds); });
    keys["snapshots"] = perScene(settings, [](const CampaignScene& s) {
      return s.effort.snapshotSeconds == 0 ? std::string("log") : fmt::format("{:g}", s.effort.snapshotSeconds);
    });
  }
  return keys;
}

std::span<const std::string_view> campaignWords() { return kDefiningOptions; }

namespace {

// Checks an option's name and how many words it has. Throws UsageError.
void checkOption(const std::string& name, const std::vector<std::string>& words) {
  const auto isAmong = [&](const auto& names) { return std::find(names.begin(), names.end(), name) != names.end(); };
  if (!isAmong(kDefiningOptions)) {
    throw UsageError(fmt::format("{}: unknown; expected one of {}", name, fmt::join(kDefiningOptions, ", ")));
  }
  if (words.empty()) throw UsageError(fmt::format("{}: has no value; expected at least one", name));
  if (words.size() > 1 && !isAmong(kListOptions)) {
    throw UsageError(fmt::format("{} {}: expected one value", name, fmt::join(words, " ")));
  }
  // A flag, which is left out where it does not hold.
  if (name == "--direct-pass" && words.front() != "yes") {
    throw UsageError(fmt::format("--direct-pass {}: expected yes, or no such option", words.front()));
  }
  for (const std::string& word : words) {
    if (!isUtf8(word)) throw UsageError(fmt::format("{} {}: is no UTF-8; expected it in results", name, word));
  }
}

}  // namespace

CampaignSettings begunCampaign(CampaignOptions& options) {
  for (const auto& [name, words] : options.defining) checkOption(name, words);
  // The settings say where the results file is.
  CampaignSettings settings = campaignSettings(options);
  const fs::path results = resultsFile(settings);
  std::error_code error;
  const bool begun = fs::exists(results, error);
  if (error) {
    throw UsageError(fmt::format("--out {}: {}; expected a folder that can be read and written", settings.out.string(),
                                 error.message()));
  }
  if (!begun) {
    refuseUnusedWords(options.defining, settings);
    checkCrops(options, settings);
    return settings;
  }
  if (!options.resume) {
    throw UsageError(fmt::format("{} exists; expected --resume to go on with it, or another --out", results.string()));
  }
  // The results file completes the options, so the settings are made anew.
  resumeCampaign(options, results);
  settings = campaignSettings(options);
  checkCrops(options, settings);
  return settings;
}

WrittenReport finishCampaign(const CampaignSettings& settings) {
  const fs::path results = resultsFile(settings);
  // Verdicts are stored first, because the report shows them.
  const std::vector<ClaimRecord> claims = judgeStudyClaims(readResults(results));
  ResultsStore(results).putClaims(claims);
  return writeReport(std::array{settings.out});
}

}  // namespace wavecrest
