// wavecrest render: one scene, one method, images and statistics out.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <thread>

#include "bench/campaign/render_stats.h"
#include "bench/film_image.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/option_values.h"
#include "cli/progress.h"
#include "cli/scene_options.h"
#include "engine/load/load.h"
#include "engine/session.h"
#include "engine/snapshots.h"
#include "metrics/image/atomic_file.h"
#include "metrics/image/image_io.h"

namespace wavecrest {
namespace {

// As written on the command line; resolved() turns words into settings.
struct RenderOptions {
  SceneOptions scene;
  std::string method = "pt", time, sampler = "independent", precision = "float", isa = "auto", accel = "auto", mlt,
              memory, snapshotEvery, stats, progress = "auto";
  uint64_t spp = 0;
  uint32_t threads = 0;
  uint64_t seed = 0;
  int maxDepth = 0, rrDepth = 0;  // 0: what the scene says
  uint32_t wave = 2048, chains = MetropolisSettings().chains, bootstrap = MetropolisSettings().bootstrapSamples,
           restart = 0;  // 0: by the number of samples
  double radius = 0.001, radiusAlpha = 0.75;
  std::vector<std::string> outputs;
  bool noDirectPass = false;
};

MetropolisSettings chosenChains(const RenderOptions& options) {
  MetropolisSettings settings;
  if (!options.mlt.empty()) {
    settings.variant = static_cast<MetropolisVariant>(parseChoice("--mlt", options.mlt, kMetropolisVariantNames));
  }
  settings.chains = options.chains;
  settings.directPass = !options.noDirectPass;
  settings.bootstrapSamples = options.bootstrap;
  if (options.restart != 0) settings.restartSteps = options.restart;
  return settings;
}

RenderSettings resolved(const RenderOptions& options, const Scene& scene) {
  RenderSettings settings;
  const std::optional<Method> method = parseMethod(options.method);
  if (!method)
    throw UsageError(fmt::format("--method {}: unknown; expected one of {}", options.method, methodChoices()));
  settings.method = *method;
  const std::optional<SamplerKind> sampler = parseSamplerKind(options.sampler);
  if (!sampler) throw UsageError(fmt::format("--sampler {}: expected independent or sobol", options.sampler));
  settings.sampler = *sampler;
  settings.precision = static_cast<Precision>(parseChoice("--precision", options.precision, kPrecisionNames));
  settings.accel = static_cast<Accel>(parseChoice("--accel", options.accel, kAccelNames));
  settings.isa = parseIsaOption(options.isa);
  settings.seed = options.seed;
  settings.threads = options.threads != 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency());
  settings.waveSize = options.wave;
  settings.metropolis = chosenChains(options);
  settings.radius = options.radius;
  settings.radiusAlpha = options.radiusAlpha;
  settings.limits = pathLimits(options.maxDepth != 0 ? options.maxDepth : scene.defaults.maxDepth,
                               options.rrDepth != 0 ? options.rrDepth : scene.defaults.rrDepth);
  if (options.spp != 0) settings.iterations = options.spp;
  if (!options.time.empty()) settings.seconds = parseDuration(options.time);
  if (!settings.iterations && !settings.seconds) settings.iterations = scene.defaults.sampleCount;
  if (!options.memory.empty()) settings.memoryBytes = parseMemory(options.memory);
  settings.measureStages = !options.stats.empty();
  return settings;
}

// NAME.0007.exr beside the output NAME.exr.
std::string snapshotPath(const std::string& output, unsigned number) {
  const std::filesystem::path path(output);
  return (path.parent_path() / fmt::format("{}.{:04}.exr", path.stem().string(), number)).string();
}

// Files of one render: the image under each requested name, snapshots beside the first, the statistics.
class Outputs {
 public:
  Outputs(const RenderOptions& options, const Scene& scene, const RenderSettings& settings, double loadSeconds)
      : options_(options), scene_(scene), settings_(settings), loadSeconds_(loadSeconds) {}

  void writeSnapshot(const Session& session, unsigned index) {
    const std::string path = snapshotPath(options_.outputs.front(), index);
    const RenderStatistics statistics = session.statistics();
    snapshots_.push_back({.number = index,
                          .renderSeconds = statistics.renderSeconds,
                          .iterations = statistics.iterations,
                          .file = path});
    writeExr(path, filmImage(session), statsMetadata(stats(statistics)));
  }

  void writeFinal(const Session& session) {
    const nlohmann::ordered_json all = stats(session.statistics());
    for (const std::string& output : options_.outputs) writeImage(output, filmImage(session), statsMetadata(all));
    if (!options_.stats.empty()) {
      const std::string text = all.dump(2) + "\n";
      writeFileAtomically(options_.stats, {reinterpret_cast<const unsigned char*>(text.data()), text.size()});
    }
  }

 private:
  nlohmann::ordered_json stats(const RenderStatistics& statistics) const {
    const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    return renderStats(scene_, settings_, statistics, loadSeconds_, wall, snapshots_);
  }

  const RenderOptions& options_;
  const Scene& scene_;
  const RenderSettings& settings_;
  const double loadSeconds_;
  const std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::vector<SnapshotRecord> snapshots_;
};

// A name that cannot be written is found before the render, not after it.
void checkOutputs(const RenderOptions& options) {
  if (options.outputs.empty() && !options.snapshotEvery.empty()) {
    throw UsageError("--snapshot-every needs an output to name the snapshots after; expected -o FILE.exr");
  }
  for (const std::string& output : options.outputs) {
    try {
      checkImageTarget(output);
    } catch (const ImageError& error) {
      throw UsageError(error.what());
    }
  }
  const std::filesystem::path folder = std::filesystem::path(options.stats).parent_path();
  if (!folder.empty() && !std::filesystem::is_directory(folder)) {
    throw UsageError(
        fmt::format("--stats {}: there is no folder '{}'; expected one that exists", options.stats, folder.string()));
  }
}

// Edges of the longest path: 1 to 64, or -1 for as many as roulette allows.
std::string checkMaxDepth(const std::string& word) {
  int depth = 0;
  const bool valid =
      readNumber(word, depth) && (depth == -1 || (depth >= 1 && depth <= static_cast<int>(kUnlimitedDepth)));
  return valid ? std::string() : fmt::format("'{}' is no depth; expected 1 to {}, or -1", word, kUnlimitedDepth);
}

// CLI11's ranges let NaN through.
std::string checkFinite(const std::string& word) {
  double number = 0;
  const bool valid = readNumber(word, number) && std::isfinite(number);
  return valid ? std::string() : fmt::format("'{}' is no finite number", word);
}

std::unique_ptr<Session> createSession(const Scene& scene, const RenderSettings& settings) {
  try {
    return Session::create(scene, settings);
  } catch (const MemoryBudgetError& error) {
    throw UsageError(fmt::format("--memory: {}", error.what()));
  }
}

// One line: the parts in MB, their sum, and the light paths where there are any.
std::string describe(const MemoryPlan& plan) {
  const MemoryUse& use = plan.use;
  std::string text;
  const auto add = [&](const char* name, size_t bytes) {
    if (bytes != 0) text += fmt::format("{} {:.1f} MB, ", name, static_cast<double>(bytes) / 1e6);
  };
  add("scene", use.scene);
  add("waves", use.waves);
  add("film", use.film);
  add("splats", use.splats);
  add("light vertices", use.lightVertices);
  add("photon map", use.photonMap);
  add("chains", use.chains);
  text += fmt::format("together {:.1f} MB", static_cast<double>(use.total()) / 1e6);
  if (plan.lightPaths != 0) text += fmt::format("; {} light paths in each iteration", plan.lightPaths);
  return text;
}

int runRender(const RenderOptions& options) {
  checkOutputs(options);
  const SnapshotSchedule schedule = parseSnapshotSchedule(options.snapshotEvery);
  const auto begin = std::chrono::steady_clock::now();
  const Scene scene = loadScene(options.scene);
  const double loadSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const RenderSettings settings = resolved(options, scene);
  const ProgressKind progressKind =
      static_cast<ProgressKind>(parseChoice("--progress", options.progress, kProgressNames));
  const std::unique_ptr<Session> session = createSession(scene, settings);
  // On request, and where light paths fill the memory.
  if (settings.memoryBytes || (session->memoryPlan().use.photonMap > 0 && progressKind != ProgressKind::none)) {
    fmt::print(stderr, "wavecrest: memory: {}\n", describe(session->memoryPlan()));
  }
  Outputs outputs(options, scene, settings, loadSeconds);

  {
    InterruptGuard guard;
    guard.watch(session.get());
    std::optional<uint64_t> goalPaths;
    if (settings.iterations) goalPaths = *settings.iterations * session->film().area().pixels.size();
    const Progress progress(progressKind, *session, settings.seconds, goalPaths);
    renderWithSnapshots(*session, settings, schedule,
                        [&](unsigned number) { outputs.writeSnapshot(*session, number); });
  }
  if (session->interrupted() && session->statistics().paths == 0) {
    fmt::print(stderr, "wavecrest: interrupted before anything was rendered; no image was written\n");
    return kExitInterrupted;
  }
  outputs.writeFinal(*session);
  return session->interrupted() ? kExitInterrupted : kExitDone;
}

}  // namespace

void addRenderCommand(CommandLine& program, int& exitCode) {
  auto options = std::make_shared<RenderOptions>();
  const Command command = program.add("render", "render a scene by one method");
  addSceneOptions(command, options->scene);
  command.add("-m,--method", options->method, "light-transport method").showDefault();
  command.add("--time", options->time, "stop after this much render time: 6s, 2m, 1h30m");
  command.add("--spp", options->spp, "stop after N iterations: paths, of mlt mutations, per pixel").positive();
  command.add("--threads", options->threads, "worker threads; default: all cores").between(1, 4096);
  command.add("--seed", options->seed, "seed of all random numbers").showDefault().notNegative();
  command.add("--sampler", options->sampler, "independent or sobol").showDefault();
  command.add("--max-depth", options->maxDepth, "edges of the longest path; -1: unlimited").checkedBy(checkMaxDepth);
  command.add("--rr-depth", options->rrDepth, "first vertex where roulette may end a path").positive();
  command.add("--precision", options->precision, "float, double or fast").showDefault();
  command.add("--isa", options->isa, "auto, scalar, sse4, avx2 or avx512").showDefault();
  command.add("--accel", options->accel, "intersector: auto, small, bvh or embree").showDefault();
  command.add("--wave", options->wave, "paths per wave").showDefault().between(16, 1 << 20);
  command.add("--radius", options->radius, "first merge radius of ppm, bpm and vcm, relative to the bounding sphere")
      .showDefault()
      .checkedBy(checkFinite)
      .between(1e-9, 10.0);
  command.add("--radius-alpha", options->radiusAlpha, "how slowly the radius shrinks, 0 to 1")
      .showDefault()
      .checkedBy(checkFinite)
      .between(0.0, 1.0);
  command.add("--memory", options->memory, "budget, as 800M or 2GiB: fewer light paths of ppm, bpm and vcm if need be");
  command.add("--mlt", options->mlt, "what the chains of mlt walk in: pssmlt, mmlt or pathspace; default: mmlt");
  command.add("--chains", options->chains, "Markov chains of mlt").showDefault().between(1, 1 << 24);
  command.add("--bootstrap", options->bootstrap, "independent samples from which chains start")
      .showDefault()
      .between(1, 1 << 28);
  command.add("--restart", options->restart, "steps before chains start anew; default: 16 mutations to a sample")
      .between(1, 1 << 28);
  command.addFlag("--no-direct-pass", options->noDirectPass, "mmlt and pathspace: chains render direct light too");
  command.add("--snapshot-every", options->snapshotEvery, "snapshots at this interval, or 'log'");
  command.add("-o,--output", options->outputs, "image file: .exr, .png or .pfm; repeatable").repeatable();
  command.add("--stats", options->stats, "write statistics as JSON");
  command.add("--progress", options->progress, "auto, bar, jsonl or none").showDefault();
  command.run([options, &exitCode] { exitCode = runRender(*options); });
}

}  // namespace wavecrest
