// wavecrest converge: a convergence campaign over scenes, methods and seeds.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "bench/campaign/run_campaign.h"
#include "bench/json_text.h"
#include "bench/live/campaign_view.h"
#include "bench/results/read_results.h"
#include "cli/commands.h"
#include "cli/findings.h"
#include "cli/interrupt.h"
#include "cli/live_render.h"
#include "cli/messages.h"
#include "cli/progress.h"
#include "library/campaign_options.h"
#include "library/campaign_rows.h"
#include "library/option_ranges.h"
#include "library/option_values.h"

namespace wavecrest {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// The library's options of a campaign, and those that only the command line has.
struct ConvergeOptions : api::CampaignOptions {
  std::string progress = "auto", view;
  bool directPass = false;
};

// ---- what people see ------------------------------------------------------------------------------------------------

// "2h05m", "3m07s" or "12s", rounded to whole seconds.
std::string durationText(double seconds) {
  const auto whole = static_cast<uint64_t>(std::max(seconds, 0.0) + 0.5);
  if (whole >= 3600) return fmt::format("{}h{:02}m", whole / 3600, whole / 60 % 60);
  return whole >= 60 ? fmt::format("{}m{:02}s", whole / 60, whole % 60) : fmt::format("{}s", whole);
}

// What is ahead, before the first run.
void showPlan(ProgressKind kind, const CampaignPlan& plan) {
  if (kind == ProgressKind::none) return;
  if (kind == ProgressKind::jsonl) {
    const json line = {{"total", plan.runs},
                       {"done", plan.done},
                       {"render_seconds", plan.renderSeconds},
                       {"unreferenced", plan.unreferenced},
                       {"reference_seconds", plan.referenceSeconds}};
    tell("{}", jsonText(line));
    return;
  }
  std::string text = plan.runs == 1 ? fmt::format("1 run, {} done", plan.done)
                                    : fmt::format("{} runs, {} of them done", plan.runs, plan.done);
  if (plan.renderSeconds > 0) text += fmt::format("; {} of render time ahead", durationText(plan.renderSeconds));
  if (!plan.unreferenced.empty()) text += fmt::format("; references to render: {}", fmt::join(plan.unreferenced, " "));
  if (plan.referenceSeconds > 0) text += fmt::format(", {}", durationText(plan.referenceSeconds));
  tell("{}", text);
}

// One line for a run that is over: the scores of its last snapshot, or why the method was refused.
void showRun(ProgressKind kind, const RunRecord& run, const CampaignProgress& progress) {
  if (kind == ProgressKind::none) return;
  if (kind == ProgressKind::jsonl) {
    json line = {{"done", progress.done},       {"total", progress.total}, {"seconds_left", progress.secondsLeft},
                 {"scene", run.scene},          {"method", run.method},    {"seed", run.seed},
                 {"state", toString(run.state)}};
    if (!run.snapshots.empty()) line["values"] = run.snapshots.back().values;
    tell("{}", jsonText(line));
    return;
  }
  // As text, only the scores that most readers want.
  std::string outcome = run.reason;
  if (!run.snapshots.empty()) {
    const SnapshotRecord& last = run.snapshots.back();
    outcome = fmt::format("{:.1f} s, {} iterations", last.renderSeconds, last.iterations);
    for (const char* name : {"rmse", "ssim", "q_mos"}) {
      const auto value = last.values.find(name);
      if (value != last.values.end()) outcome += fmt::format(", {} {:.4g}", name, value->second);
    }
    const json stats = json::parse(run.stats);
    const auto leftOut = stats.value("snapshots_left_out", 0U);
    if (leftOut > 0) {
      outcome += fmt::format("; {} snapshot{} before the first whole image left out", leftOut, leftOut == 1 ? "" : "s");
    }
    for (const json& doubt : stats.value("doubts", json::array())) outcome += "; doubt: " + doubt.get<std::string>();
  }
  tell("[{}/{}] {} left  {} {} seed {}: {}", progress.done, progress.total, durationText(progress.secondsLeft),
       run.scene, run.method, run.seed, outcome);
}

// The last line after a signal.
std::string stopLine(const ConvergeOptions& options) {
  return fmt::format("stopped; `wavecrest converge --out {} --resume` goes on", options.out);
}

// Starts the page of --view and shows runs of earlier processes on it. Null where no page was asked for.
std::unique_ptr<CampaignView> openPage(const ConvergeOptions& options, const CampaignSettings& settings,
                                       ProgressKind kind) {
  if (options.view.empty()) return nullptr;
  std::unique_ptr<CampaignView> view;
  try {
    view = std::make_unique<CampaignView>(*parseHostPort(options.view), settings);
  } catch (const std::runtime_error& error) {
    throw UsageError(fmt::format("--view {}", error.what()));
  }
  tellPage(kind, view->url());
  if (const fs::path results = resultsFile(settings); fs::exists(results)) view->showEarlier(readResults(results));
  return view;
}

// Variables are defaults, which rows that take no sampler ignore, and defaults of a new campaign: one that goes on has
// its own.
void forgetCampaignVariables(ConvergeOptions& options, const Command& command) {
  if (command.fromVariable("--sampler") && std::ranges::none_of(campaignSettings(options).methods, takesSampler)) {
    options.defining.erase("--sampler");
  }
  if (!options.resume) return;
  ConvergeOptions without = options;
  for (const char* name : {"--size", "--precision", "--sampler"}) {
    if (command.fromVariable(name)) without.defining.erase(name);
  }
  if (command.fromVariable("--threads")) without.threads = 0;
  std::error_code ignored;
  if (fs::exists(resultsFile(campaignSettings(without)), ignored)) options = without;
}

int runConverge(ConvergeOptions options) {
  // Settings, of options and of the results file that the campaign goes on with.
  const CampaignSettings settings = begunCampaign(options);
  const fs::path results = resultsFile(settings);
  const auto kind = static_cast<ProgressKind>(parseChoice("--progress", options.progress, kProgressNames));
  // Page, signals and what is shown of the campaign.
  const std::unique_ptr<CampaignView> view = openPage(options, settings, kind);
  InterruptGuard guard(messageLine(kind, stopLine(options), ""));
  const CampaignHooks hooks{.session = {.watch = [&](Session* session) { guard.watch(session); },
                                        .goesOn =
                                            [&] {
                                              guard.takeSaveRequest();  // what is done is saved
                                              guard.goOn();
                                              return !guard.interrupted();
                                            },
                                        .idle = [&](bool idle) { guard.setIdle(idle); }},
                            .stopped = [&] { return guard.interrupted(); },
                            .planned =
                                [&](const CampaignPlan& plan) {
                                  showPlan(kind, plan);
                                  if (view) view->showPlan(plan);
                                },
                            .finished =
                                [&](const RunRecord& run, const CampaignProgress& progress) {
                                  showRun(kind, run, progress);
                                  if (view) view->showRun(run, progress);
                                },
                            .say =
                                [&](const std::string& line) {
                                  if (kind != ProgressKind::none) tellMessage(kind, line, "");
                                }};
  // Runs the campaign.
  const bool complete = runCampaign(settings, campaignKeys(options, settings), hooks);
  if (view) view->showEnd(complete);
  if (!complete) {
    tellMessage(kind, stopLine(options), "");
    return kExitInterrupted;
  }
  printOut("{}\n", results.string());
  // A shard is only a part. `wavecrest report` judges and shows all parts together.
  if (settings.shard.count > 1) return kExitDone;
  // Judges the findings and writes the report.
  const WrittenReport report = finishCampaign(settings);
  for (const fs::path& file : report.files) printOut("{}\n", file.string());
  return options.check ? showFindings(report.claims, kind) : kExitDone;
}

}  // namespace

void addConvergeCommand(CommandLine& program, int& exitCode) {
  auto options = std::make_shared<ConvergeOptions>();
  const Command command = program.add("converge", "measure how methods converge: scenes x methods x seeds");
  // Adds an option that is part of what the campaign is. Its words go into `defining` under its name.
  const auto defining = [&](const char* name, const char* description) {
    return command.add(name, options->defining[name], description);
  };
  // What the campaign is: stored with the results, and compared with them by --resume.
  defining("scenes", "built-in scenes or XML files; default: the nine, as far as they are there");
  defining(
      "--methods",
      "methods, separated by commas; also mlt-pathspace, mlt-pssmlt, ppm-direct, and METHOD-auto, with the defaults of "
      "render; default: the profile's")
      .separatedByCommas()
      .repeatable();
  defining("--profile", "quick, standard, study or paper; default: quick").oneValue();
  defining("--time", "render time of each run; default: the profile's").oneValue();
  defining("--time-factor", "multiplies the profile's run times, as 0.25").oneValue();
  defining("--snapshot-every", "interval between snapshots, or log; default: the profile's").oneValue();
  defining("--spp", "iterations of each run instead of time; snapshots after 1, 2, 4, ...").oneValue();
  defining("--seeds", "runs of each method, seeds 1 to N; default: the profile's").oneValue();
  defining("--size", "film size, WIDTHxHEIGHT; default: the profile's").oneValue();
  defining("--precision", "float or double; default: float").oneValue();
  defining("--sampler", "independent, sobol, or auto: by method; default: the profile's").oneValue();
  defining("--images", "keep images of 'all' snapshots, or of the 'last' of each run; default: all").oneValue();
  defining("--radius",
           "first merge radius of ppm, bpm and vcm, relative to the bounding sphere, or auto; default: the profile's")
      .oneValue();
  defining("--radius-alpha", "how slowly the radius shrinks, 0 to 1; default: 0.75").oneValue();
  defining("--merge-vertices", "where camera paths of vcm merge: all or first; default: the profile's").oneValue();
  defining("--light-paths",
           "light paths of an iteration of ppm, bpm and vcm; default: the profile's, or as many as pixels and of ppm "
           "and bpm at least 4096")
      .oneValue();
  defining("--roulette", "what decides whether walks go on: throughput, albedo or efficiency; default: the profile's")
      .oneValue();
  defining("--mlt", "what the row mlt stands for: pathspace, mmlt, pssmlt, separated by commas; default: mmlt")
      .separatedByCommas()
      .repeatable();
  command.addFlag("--direct-pass", options->directPass, "ppm also with direct light by next event estimation");
  defining("--clock", "what a run is charged: wall, or cpu time over threads; both are stored; default: wall")
      .oneValue();
  defining("--crop", "part of the pictures that the report has a button for: SCENE:X,Y,WIDTHxHEIGHT").repeatable();
  defining("-D", "value of the scenes' $name: NAME=VALUE").repeatable();
  // How this process runs it.
  command.add("--threads", options->threads, "worker threads; default: all cores").between(kThreadRange);
  command.add("--isa", options->isa, "auto, scalar, sse4, avx2 or avx512").showDefault();
  command.add("--out", options->out, "folder of results.sqlite, images and references").showDefault();
  command.add("--reference", options->reference, "folder of SCENE.exr; default: those that come with the scenes");
  command.add("--shard", options->shard, "i/n: do only the i-th of n parts").showDefault();
  command.add("--progress", options->progress, "auto, bar, jsonl or none").showDefault();
  addViewOption(command, options->view);
  command.addFlag("--checkpoints", options->checkpoints,
                  "write a checkpoint of each run with the first snapshot after each minute, and at its end: --resume "
                  "goes on from it, also with more time");
  command.addFlag("--resume", options->resume,
                  "go on with the campaign in --out, or extend it: more scenes, methods, seeds, time");
  command.addFlag("--check", options->check, "fail with exit code 4 where a finding of the study does not hold");
  command.run([options, command, &exitCode] {
    // Registration has made an entry for every option. Only those that were given stay.
    for (const std::string_view name : campaignWords()) {
      if (!command.given(std::string(name))) options->defining.erase(std::string(name));
    }
    if (options->directPass) options->defining["--direct-pass"] = {"yes"};
    forgetCampaignVariables(*options, command);
    exitCode = runConverge(*options);
  });
}

}  // namespace wavecrest
