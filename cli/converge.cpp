// wavecrest converge: a convergence campaign over scenes, methods and seeds.
#include <fmt/core.h>

#include <charconv>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "bench/campaign/file_lock.h"
#include "bench/campaign/run_campaign.h"
#include "bench/campaign/scene_reference.h"
#include "bench/claims/judge_claims.h"
#include "bench/report/results_folder.h"
#include "bench/report/write_report.h"
#include "bench/results/read_results.h"
#include "bench/results/results_store.h"
#include "cli/commands.h"
#include "cli/findings.h"
#include "cli/interrupt.h"
#include "cli/messages.h"
#include "cli/option_values.h"
#include "cli/progress.h"
#include "engine/load/load.h"
#include "scenes/scene_list.h"

namespace wavecrest {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// Options that say what the campaign is: stored with it as they were given, so that --resume needs none of them, and
// refused where they differ. How it is run (threads, folder, progress) may change from one process to the next.
constexpr const char* kDefiningOptions[] = {"scenes",           "--methods", "--profile", "--time",
                                            "--snapshot-every", "--spp",     "--seeds",   "--precision",
                                            "--sampler",        "--size",    "--images"};

struct ConvergeOptions {
  std::map<std::string, std::vector<std::string>> defining;  // by option name; only what was given
  std::string out = "out/converge", reference, shard = "1/1", isa = "auto", progress = "auto";
  uint32_t threads = 0;
  bool resume = false, check = false;

  bool has(const char* name) const { return defining.contains(name); }
  std::string get(const char* name, const std::string& otherwise = "") const {
    const auto found = defining.find(name);
    return found == defining.end() ? otherwise : found->second.front();
  }
};

// ---- from words to settings -----------------------------------------------------------------------------------------

// A whole number from 1 on, or 0 for any other text.
uint32_t countOf(std::string_view text) {
  uint32_t count = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  return error == std::errc() && rest == text.data() + text.size() ? count : 0;
}

uint32_t parseCount(const char* option, const std::string& text) {
  const uint32_t count = countOf(text);
  if (count == 0) throw UsageError(fmt::format("{} {}: expected a whole number from 1 on", option, text));
  return count;
}

Shard parseShard(const std::string& text) {
  const size_t slash = text.find('/');
  if (slash == std::string::npos) throw UsageError(fmt::format("--shard {}: expected i/n", text));
  const Shard shard{countOf(text.substr(0, slash)), countOf(text.substr(slash + 1))};
  if (shard.index == 0 || shard.index > shard.count) {
    throw UsageError(fmt::format("--shard {}: expected i/n with i from 1 to n", text));
  }
  return shard;
}

std::vector<Method> chosenMethods(const ConvergeOptions& options) {
  std::vector<Method> methods;
  if (!options.has("--methods")) {
    for (const MethodEntry& entry : kMethods) methods.push_back(entry.method);
    return methods;
  }
  for (const std::string& word : options.defining.at("--methods")) {
    const Method method = parseMethodOption("--methods", word);
    if (std::find(methods.begin(), methods.end(), method) == methods.end()) methods.push_back(method);
  }
  return methods;
}

const Profile& chosenProfile(const ConvergeOptions& options) {
  const std::string name = options.get("--profile", "quick");
  if (const Profile* profile = findProfile(name)) return *profile;
  std::string names;
  for (const Profile& profile : profiles()) names += (names.empty() ? "" : ", ") + std::string(profile.name);
  throw UsageError(fmt::format("--profile {}: unknown; expected one of {}", name, names));
}

Effort effortOf(const ConvergeOptions& options, const Profile& profile, std::string_view scene) {
  Effort effort = profile.effort(scene);
  if (options.has("--time")) effort.seconds = parseDuration(options.get("--time"));
  if (options.has("--snapshot-every")) {
    const std::string every = options.get("--snapshot-every");
    effort.snapshotSeconds = every == "log" ? 0 : parseDuration(every);
  }
  return effort;
}

std::vector<CampaignScene> chosenScenes(const ConvergeOptions& options, const Profile& profile) {
  std::vector<std::string> words;
  if (options.has("scenes")) {
    words = options.defining.at("scenes");
  } else {
    for (const SceneEntry& entry : builtInScenes()) words.emplace_back(entry.name);
  }
  std::vector<CampaignScene> scenes;
  std::set<std::string> names;
  for (const std::string& word : words) {
    const fs::path file = findScene(word);
    const std::string name = file.stem().string();
    if (!names.insert(name).second) throw UsageError(fmt::format("{}: a second scene of the name '{}'", word, name));
    scenes.push_back({.name = name, .file = file, .effort = effortOf(options, profile, name)});
  }
  return scenes;
}

RenderSettings renderSettings(const ConvergeOptions& options) {
  RenderSettings render;
  render.threads = options.threads != 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency());
  render.isa = parseIsaOption(options.isa);
  render.precision =
      static_cast<Precision>(parseChoice("--precision", options.get("--precision", "float"), kPrecisionNames));
  const std::string sampler = options.get("--sampler", "independent");
  const std::optional<SamplerKind> kind = parseSamplerKind(sampler);
  if (!kind) throw UsageError(fmt::format("--sampler {}: expected independent or sobol", sampler));
  render.sampler = *kind;
  return render;
}

CampaignSettings campaignSettings(const ConvergeOptions& options) {
  const Profile& profile = chosenProfile(options);
  CampaignSettings settings;
  settings.methods = chosenMethods(options);
  settings.scenes = chosenScenes(options, profile);
  settings.seeds = profile.seeds;
  if (options.has("--seeds")) settings.seeds = parseCount("--seeds", options.get("--seeds"));
  if (options.has("--spp")) settings.iterations = parseCount("--spp", options.get("--spp"));
  if (settings.iterations && (options.has("--time") || options.get("--snapshot-every", "log") != "log")) {
    throw UsageError(
        "--spp counts iterations and takes snapshots after 1, 2, 4, ...; expected no --time or "
        "--snapshot-every beside it");
  }
  settings.size = options.has("--size") ? parseSize(options.get("--size")) : profile.size;
  settings.render = renderSettings(options);
  settings.out = options.out;
  settings.shard = parseShard(options.shard);
  constexpr std::array<std::string_view, 2> kImageChoices{"all", "last"};
  settings.keepImages = parseChoice("--images", options.get("--images", "all"), kImageChoices) == 0;
  settings.referenceRequired = !options.reference.empty();
  settings.referenceFolder = options.reference.empty() ? sceneFolder() / "references" : fs::path(options.reference);
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

std::map<std::string, std::string> campaignKeys(const ConvergeOptions& options, const CampaignSettings& settings) {
  std::vector<std::string> scenes, methods;
  for (const CampaignScene& scene : settings.scenes) scenes.push_back(scene.name);
  for (const Method method : settings.methods) methods.emplace_back(toString(method));
  std::map<std::string, std::string> keys{
      {"options", json(options.defining).dump()},
      {"profile", std::string(chosenProfile(options).name)},
      {"scenes", joined(scenes)},
      {"methods", joined(methods)},
      {"seeds", std::to_string(settings.seeds)},
      {"size", fmt::format("{}x{}", settings.size[0], settings.size[1])},
      {"precision", std::string(kPrecisionNames[static_cast<size_t>(settings.render.precision)])},
      {"sampler", std::string(toString(settings.render.sampler))},
      {"shard", fmt::format("{}/{}", settings.shard.index, settings.shard.count)}};
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

// The words of a list option, its default spelt out.
std::vector<std::string> listed(const ConvergeOptions& options, const std::string& name) {
  if (options.has(name.c_str())) return options.defining.at(name);
  std::vector<std::string> words;
  if (name == "scenes") {
    for (const SceneEntry& entry : builtInScenes()) words.emplace_back(entry.name);
  } else {
    for (const MethodEntry& entry : kMethods) words.emplace_back(entry.name);
  }
  return words;
}

// Whether every run of `after` takes at least as long as the same run of `before`, all else being equal.
bool isLonger(const ConvergeOptions& before, const ConvergeOptions& after) {
  const CampaignSettings a = campaignSettings(before), b = campaignSettings(after);
  if (a.iterations.has_value() != b.iterations.has_value()) return false;
  if (a.iterations) return *b.iterations >= *a.iterations;
  for (size_t i = 0; i < a.scenes.size(); ++i) {
    if (b.scenes[i].effort.seconds < a.scenes[i].effort.seconds) return false;
  }
  return true;
}

// `before` with the words of one option, if that makes the campaign larger: further scenes or methods, more seeds, time
// or iterations. Otherwise nothing.
std::optional<ConvergeOptions> extended(const ConvergeOptions& before, const std::string& name,
                                        const std::vector<std::string>& words) {
  ConvergeOptions after = before;
  if (name == "scenes" || name == "--methods") {
    std::vector<std::string> all = listed(before, name);
    const size_t known = all.size();
    for (const std::string& word : words) {
      if (std::find(all.begin(), all.end(), word) == all.end()) all.push_back(word);
    }
    after.defining[name] = all;
    return all.size() > known ? std::optional(after) : std::nullopt;
  }
  after.defining[name] = words;
  if (name == "--seeds") {
    return campaignSettings(after).seeds > campaignSettings(before).seeds ? std::optional(after) : std::nullopt;
  }
  if (name == "--time" || name == "--spp") return isLonger(before, after) ? std::optional(after) : std::nullopt;
  return std::nullopt;
}

// Takes from an earlier process of the same campaign what was not given again, and adds what makes it larger.
void resume(ConvergeOptions& options, const fs::path& results) {
  const FileLock lock(results);
  const ResultsStore whole(results);  // also where a process died before it had made the tables
  const CampaignResults before = readResults(results);
  const auto stored = before.campaign.find("options");
  if (stored == before.campaign.end()) return;  // it died before it began
  const auto defining = json::parse(stored->second).get<std::map<std::string, std::vector<std::string>>>();
  ConvergeOptions all = options;
  all.defining = defining;
  for (const auto& [name, words] : options.defining) {
    const auto known = defining.find(name);
    if (known != defining.end() && known->second == words) continue;
    const std::optional<ConvergeOptions> larger = extended(all, name, words);
    if (!larger) {
      throw UsageError(fmt::format("{} {}: {} was begun with {}; expected the same, more, or another --out", name,
                                   joined(words), results.string(),
                                   known == defining.end() ? "the default" : joined(known->second)));
    }
    if (name == "--methods" && campaignSettings(all).shard.count > 1) {
      throw UsageError("--methods: shards divide scenes and methods, so none can be added; expected another --out");
    }
    all = *larger;
  }
  options.defining = all.defining;
}

// ---- what people see ------------------------------------------------------------------------------------------------

std::string durationText(double seconds) {
  const auto whole = static_cast<uint64_t>(std::max(seconds, 0.0) + 0.5);
  if (whole >= 3600) return fmt::format("{}h{:02}m", whole / 3600, whole / 60 % 60);
  return whole >= 60 ? fmt::format("{}m{:02}s", whole / 60, whole % 60) : fmt::format("{}s", whole);
}

void showPlan(ProgressKind kind, const CampaignPlan& plan) {
  if (kind == ProgressKind::none) return;
  if (kind == ProgressKind::jsonl) {
    const json line = {{"total", plan.runs},
                       {"done", plan.done},
                       {"render_seconds", plan.renderSeconds},
                       {"unreferenced", plan.unreferenced},
                       {"reference_seconds", plan.referenceSeconds}};
    tell("{}", line.dump());
    return;
  }
  std::string text = fmt::format("{} runs, {} of them done", plan.runs, plan.done);
  if (plan.renderSeconds > 0) text += fmt::format("; {} of render time ahead", durationText(plan.renderSeconds));
  if (!plan.unreferenced.empty()) text += fmt::format("; references to render: {}", joined(plan.unreferenced));
  if (plan.referenceSeconds > 0) text += fmt::format(", {}", durationText(plan.referenceSeconds));
  tell("{}", text);
}

void showRun(ProgressKind kind, const RunRecord& run, const CampaignProgress& progress) {
  if (kind == ProgressKind::none) return;
  if (kind == ProgressKind::jsonl) {
    json line = {{"done", progress.done},       {"total", progress.total}, {"seconds_left", progress.secondsLeft},
                 {"scene", run.scene},          {"method", run.method},    {"seed", run.seed},
                 {"state", toString(run.state)}};
    if (!run.snapshots.empty()) line["values"] = run.snapshots.back().values;
    tell("{}", line.dump());
    return;
  }
  std::string outcome = run.reason;
  if (!run.snapshots.empty()) {
    const SnapshotRecord& last = run.snapshots.back();
    outcome = fmt::format("{:.1f} s, {} iterations", last.renderSeconds, last.iterations);
    for (const char* name : {"rmse", "ssim", "q_mos"}) {
      const auto value = last.values.find(name);
      if (value != last.values.end()) outcome += fmt::format(", {} {:.4g}", name, value->second);
    }
  }
  tell("[{}/{}] {} left  {} {} seed {}: {}", progress.done, progress.total, durationText(progress.secondsLeft),
       run.scene, run.method, run.seed, outcome);
}

void storeClaims(const fs::path& results) {
  const std::vector<ClaimRecord> claims = judgeStudyClaims(readResults(results));
  ResultsStore(results).putClaims(claims);
}

std::string stopLine(const ConvergeOptions& options) {
  return fmt::format("stopped; `wavecrest converge --out {} --resume` goes on", options.out);
}

int runConverge(ConvergeOptions options) {
  CampaignSettings settings = campaignSettings(options);
  const fs::path results = resultsFile(settings);
  if (fs::exists(results)) {
    if (!options.resume) {
      throw UsageError(
          fmt::format("{} exists; expected --resume to go on with it, or another --out", results.string()));
    }
    resume(options, results);
    settings = campaignSettings(options);
  }
  const auto kind = static_cast<ProgressKind>(parseChoice("--progress", options.progress, kProgressNames));
  InterruptGuard guard(stopLine(options));
  const CampaignHooks hooks{
      .session = {.watch = [&](Session* session) { guard.watch(session); },
                  .goesOn =
                      [&] {
                        guard.takeSaveRequest();  // what is done is saved
                        guard.goOn();
                        return !guard.interrupted();
                      },
                  .idle = [&](bool idle) { guard.setIdle(idle); }},
      .stopped = [&] { return guard.interrupted(); },
      .planned = [&](const CampaignPlan& plan) { showPlan(kind, plan); },
      .finished = [&](const RunRecord& run, const CampaignProgress& progress) { showRun(kind, run, progress); },
      .say =
          [&](const std::string& line) {
            if (kind == ProgressKind::jsonl) {
              tell("{}", json{{"message", line}}.dump());
            } else if (kind != ProgressKind::none) {
              tell("{}", line);
            }
          }};
  if (!runCampaign(settings, campaignKeys(options, settings), hooks)) {
    tell("{}", stopLine(options));
    return kExitInterrupted;
  }
  fmt::print("{}\n", results.string());
  if (settings.shard.count > 1) return kExitDone;  // the whole is judged and shown where all parts are read
  storeClaims(results);
  const WrittenReport report = writeReport(std::array{settings.out});
  for (const fs::path& file : report.files) fmt::print("{}\n", file.string());
  return options.check ? showFindings(report.claims) : kExitDone;
}

}  // namespace

void addConvergeCommand(CommandLine& program, int& exitCode) {
  auto options = std::make_shared<ConvergeOptions>();
  const Command command = program.add("converge", "measure how methods converge: scenes x methods x seeds");
  const auto defining = [&](const char* name, const char* description) {
    return command.add(name, options->defining[name], description);
  };
  defining("scenes", "built-in scenes or XML files; default: the nine");
  defining("--methods", "methods, separated by commas; default: all").separatedByCommas();
  defining("--profile", "quick, standard or paper; default: quick").oneValue();
  defining("--time", "render time of each run; default: the profile's").oneValue();
  defining("--snapshot-every", "interval between snapshots, or log; default: the profile's").oneValue();
  defining("--spp", "iterations of each run instead of time; snapshots after 1, 2, 4, ...").oneValue();
  defining("--seeds", "runs of each method, seeds 1 to N; default: the profile's").oneValue();
  defining("--size", "film size, WIDTHxHEIGHT; default: the profile's").oneValue();
  defining("--precision", "float, double or fast; default: float").oneValue();
  defining("--sampler", "independent or sobol; default: independent").oneValue();
  defining("--images", "keep images of 'all' snapshots, or of the 'last' of each run; default: all").oneValue();
  command.add("--threads", options->threads, "worker threads; default: all cores").between(1, 4096);
  command.add("--isa", options->isa, "auto, scalar, sse4, avx2 or avx512").showDefault();
  command.add("--out", options->out, "folder of results.sqlite, images and references").showDefault();
  command.add("--reference", options->reference, "folder of SCENE.exr; default: those that come with the scenes");
  command.add("--shard", options->shard, "i/n: do only the i-th of n parts").showDefault();
  command.add("--progress", options->progress, "auto, bar, jsonl or none").showDefault();
  command.addFlag("--resume", options->resume,
                  "go on with the campaign in --out, or extend it: more scenes, methods, seeds, time");
  command.addFlag("--check", options->check, "fail with exit code 4 where a finding of the study does not hold");
  command.run([options, command, &exitCode] {
    for (const char* name : kDefiningOptions) {
      if (!command.given(name)) options->defining.erase(name);
    }
    try {
      exitCode = runConverge(*options);
    } catch (const ReferenceError& error) {
      throw InputError(error.what());
    } catch (const FileLockError& error) {
      throw InputError(error.what());
    } catch (const ReferenceMismatch& error) {
      throw InputError(error.what());
    } catch (const ResultsFileError& error) {
      throw InputError(error.what());
    } catch (const ResultsError& error) {
      throw InputError(error.what());
    }
  });
}

}  // namespace wavecrest
