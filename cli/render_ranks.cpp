#include "cli/render_ranks.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>

#include "bench/checkpoint/checkpoint.h"
#include "bench/machine/placement.h"
#include "cli/commands.h"
#include "cli/file_check.h"
#include "cli/messages.h"
#include "cli/pinning.h"
#include "engine/tasks/processors.h"

namespace wavecrest {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// Checkpoints of the same name that other numbers of processes have left; empty: none.
std::string sharesOfOthers(const std::string& file, uint32_t count) {
  const fs::path path = fs::path(file);
  const std::string begin = path.filename().string() + "-1-of-", own = begin + std::to_string(count);
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(path.has_parent_path() ? path.parent_path() : fs::path("."), error)) {
    const std::string name = entry.path().filename().string();
    const bool number = name.starts_with(begin) && name.size() > begin.size() &&
                        std::all_of(name.begin() + static_cast<std::ptrdiff_t>(begin.size()), name.end(),
                                    [](unsigned char c) { return c >= '0' && c <= '9'; });
    if (number && name != own) return (path.parent_path() / name).string();
  }
  return {};
}

}  // namespace

RenderRanks::RenderRanks() {
  const std::optional<Launch> launch = launchOfThisProcess();
  if (!launch) return;
  ranks_.emplace(*launch);
  places_ = ranks_->exchange(placeOfThisProcess());
}

std::function<uint64_t()> RenderRanks::pathsElsewhere() const {
  if (!several() || !first()) return {};
  return [this] { return ranks_->pathsElsewhere(); };
}

std::string RenderRanks::fileOfShare(const std::string& file) const {
  return fmt::format("{}-{}-of-{}", file, ranks_->rank() + 1, ranks_->count());
}

void RenderRanks::adapt(RenderOptions& options) {
  if (!several()) return;
  // Before the name gets a number for each process.
  if (options.checkpoint.file == kStandardStream) throw UsageError("--checkpoint -: expected a file");
  // What would show or decide by the share of one process alone.
  const std::pair<const char*, bool> alone[] = {{"--part", !options.part.empty()},
                                                {"--view", !options.live.view.empty()},
                                                {"--tev", !options.live.tev.empty()},
                                                {"--until-relative-error", options.until.relativeError > 0},
                                                {"--until-ssim", options.until.ssim > 0}};
  for (const auto& [name, given] : alone) {
    if (given)
      throw UsageError(
          fmt::format("{}: not in one of {} processes; expected one process, or none of it", name, ranks_->count()));
  }
  // Processes on one machine that may run on the same processors share them.
  if (options.threads == 0) {
    const auto sharing = std::count(places_.begin(), places_.end(), places_[ranks_->rank()]);
    options.threads = std::max(1u, allowedProcessors() / static_cast<uint32_t>(sharing));
  }
  threads_ = options.threads;
  // Files.
  if (options.checkpoint.file.empty()) {
    const fs::path output = options.outputs.empty() ? fs::path("render") : fs::path(options.outputs.front());
    emergencyFile_ = fileOfShare((output.parent_path() / output.stem()).string() + ".part");
  } else {
    const std::string others = sharesOfOthers(options.checkpoint.file, ranks_->count());
    if (!others.empty()) {
      throw InputError(
          fmt::format("{}: is of another number of processes; expected that number again, or another "
                      "--checkpoint (`wavecrest merge` adds up what there is)",
                      others));
    }
    options.checkpoint.file = fileOfShare(options.checkpoint.file);
  }
  if (!first()) {
    options.outputs.clear();
    options.stats.clear();
    options.exposure = 0;
  }
}

RenderSettings RenderRanks::share(const RenderSettings& settings, const Scene& scene, ProgressKind kind) const {
  if (!several()) return settings;
  if (settings.method == Method::mlt) {
    if (settings.metropolis.chains < ranks_->count()) {
      throw UsageError(fmt::format("--chains {}: fewer than the {} processes; expected at least one for each",
                                   settings.metropolis.chains, ranks_->count()));
    }
    note(kind, fmt::format("mlt: each of {} processes traces all bootstraps; a longer --restart has fewer of them",
                           ranks_->count()));
  } else if (settings.iterations && *settings.iterations < ranks_->count()) {
    warn(kind, fmt::format("--spp {}: {} processes share as many iterations; some of them have none",
                           *settings.iterations, ranks_->count()));
  }
  RenderSettings own = settingsOfJointShare(settings, ranks_->rank(), ranks_->count());
  // The budget is of all that a process takes.
  const uint64_t sums = bytesOfSums(scene, own, ranks_->count());
  if (own.memoryBytes && *own.memoryBytes <= sums) {
    throw UsageError(fmt::format("--memory: the sums of several processes take {:.1f} MB; expected more than that",
                                 static_cast<double>(sums) / 1e6));
  }
  if (own.memoryBytes) *own.memoryBytes -= sums;
  return own;
}

Placement RenderRanks::pinned(uint32_t threads, ProgressKind kind) const {
  if (!several()) return pinnedPlacement(threads, kind);
  // Threads of all processes here, and of those before this one: each process may have another number.
  uint32_t before = 0, all = 0;
  for (uint32_t rank = 0; rank < ranks_->count(); ++rank) {
    if (places_[rank] != places_[ranks_->rank()]) continue;
    if (rank < ranks_->rank()) before += threadsOfAll_[rank];
    all += threadsOfAll_[rank];
  }
  const Placement placement = pinnedPlacement(all, kind);
  return placement.cpus.empty() ? placement : partOf(placement, usableHardwareThreads(), before, threads);
}

void RenderRanks::cutAlike(RenderSettings& settings) {
  if (!several()) return;
  const std::vector<std::string> all =
      ranks_->exchange(fmt::format("{} {}", settings.cutForThreads(), settings.threads));
  settings.piecesForThreads = static_cast<uint32_t>(std::stoul(all.front()));
  threadsOfAll_.clear();
  for (const std::string& one : all) {
    threadsOfAll_.push_back(static_cast<uint32_t>(std::stoul(one.substr(one.find(' ')))));
  }
}

void RenderRanks::together(const std::function<void()>& step) {
  if (!several()) return step();
  Failure own;
  try {
    step();
  } catch (...) {
    own = failureOf(std::current_exception());
  }
  const std::vector<std::string> all = ranks_->exchange(
      Json{{"code", own.exitCode}, {"line", own.line}}.dump(-1, ' ', false, Json::error_handler_t::replace));
  for (size_t rank = 0; rank < all.size(); ++rank) {
    const Json one = Json::parse(all[rank]);
    Failure failure{one.at("code").get<int>(), one.at("line").get<std::string>()};
    if (failure.exitCode == 0) continue;
    if (rank != 0) failure.line += fmt::format(" (process {} of {})", rank + 1, all.size());
    if (first()) tell("wavecrest: {}", failure.line);
    throw SharedFailure{failure.exitCode};
  }
}

unsigned RenderRanks::agree(const Json& identity, const Session& session, unsigned firstSnapshot,
                            RenderOutputs& outputs) {
  if (!several()) return firstSnapshot;
  const RenderStatistics statistics = session.statistics();
  const std::vector<std::string> all = ranks_->exchange(
      Json{{"render", identity}, {"snapshot", firstSnapshot}, {"iterations", statistics.iterations}}.dump());
  unsigned first = 0;
  std::vector<uint64_t> iterations;
  together([&] {
    const Json wanted = Json::parse(all.front()).at("render");
    for (size_t rank = 0; rank < all.size(); ++rank) {
      const Json one = Json::parse(all[rank]);
      requireSameRender(fmt::format("process {} of {}", rank + 1, all.size()), one.at("render"), wanted, kShareKeys,
                        "expected the same program and settings in all processes (where machines differ, one --isa and "
                        "--threads)");
      first = std::max(first, one.at("snapshot").get<unsigned>());
      iterations.push_back(one.at("iterations").get<uint64_t>());
    }
  });
  // Shares of mlt are chains, in all iterations.
  if (this->first()) {
    outputs.setResumedFrom(statistics.chains ? *std::min_element(iterations.begin(), iterations.end())
                                             : std::accumulate(iterations.begin(), iterations.end(), uint64_t{0}));
  }
  return first;
}

RenderRanks::Watch::Watch(RenderRanks& ranks, InterruptGuard& guard, const Session& session, RenderOutputs& outputs)
    : ranks_(ranks) {
  if (!ranks_.several()) return;
  ranks_.area_ = session.film().area();
  ranks_.ranks_->watch({.interrupted = [&guard] { return guard.interrupted(); },
                        .saveWanted = [&guard] { return guard.takeSaveRequest(); },
                        .stop = [&guard] { guard.stop(); },
                        .attend = [&guard] { guard.requestAttention(); },
                        .paths = [&session] { return session.progressPaths(); },
                        .rescue = [&ranks, &session, &outputs] { ranks.saveShare(session, outputs); }});
}

RenderRanks::Watch::~Watch() {
  if (ranks_.several()) ranks_.ranks_->watch({});
}

void RenderRanks::snapshot(const Session& session, unsigned number, RenderOutputs& outputs) {
  if (!several()) {
    outputs.writeSnapshot(renderedBy(session), number);
  } else {
    ranks_->contribute(snapshotLabel(number), session, threads_);
  }
}

void RenderRanks::attend(const Session& session, bool save, RenderOutputs& outputs) {
  if (!several()) {
    if (save) outputs.writeCheckpoint(session);
    if (save) outputs.save(renderedBy(session));
    return;
  }
  if (save) ranks_->requestSave();
  for (const SumLabel label : ranks_->takeSaves()) {
    outputs.writeCheckpoint(session);
    ranks_->contribute(label, session, threads_);
  }
  while (std::optional<RankSum> sum = ranks_->takeSum()) write(std::move(*sum), outputs);
}

Rendered RenderRanks::rendered(RankSum sum) const {
  Json processes = std::move(sum.processes);
  Image image{.width = area_.width, .height = area_.height, .channels = 3, .pixels = std::move(sum.image)};
  return {.statistics = std::move(sum.statistics),
          .image = [image = std::move(image)] { return image; },
          .processes = std::move(processes)};
}

void RenderRanks::write(RankSum sum, RenderOutputs& outputs) {
  const SumLabel label = sum.label;
  if (isSnapshot(label)) {
    outputs.writeSnapshot(rendered(std::move(sum)), static_cast<unsigned>(label));
  } else {
    outputs.save(rendered(std::move(sum)));
  }
}

void RenderRanks::saveShare(const Session& session, RenderOutputs& outputs) {
  if (!shareSaved_) shareSaved_ = outputs.writeCheckpoint(session, emergencyFile_);
}

std::optional<Rendered> RenderRanks::whole(const Session& session, RenderOutputs& outputs) {
  if (!several()) return renderedBy(session);
  ranks_->contribute(kFinalLabel, session, threads_);
  if (!first()) return std::nullopt;
  for (;;) {
    RankSum sum = ranks_->waitForSum();
    if (sum.label == kFinalLabel) return rendered(std::move(sum));
    write(std::move(sum), outputs);
  }
}

void RenderRanks::finish() {
  if (several()) ranks_->finish();
}

int RenderRanks::leave(int exitCode) {
  if (!several()) return exitCode;
  // A file that could not be written comes before an interrupt.
  const std::vector<std::string> codes = ranks_->exchange(std::to_string(exitCode));
  int all = kExitDone;
  for (const std::string& one : codes) {
    const int code = std::stoi(one);
    if (code != kExitDone && (all == kExitDone || all == kExitInterrupted)) all = code;
  }
  // Before MPI ends: with a launcher that is ending its processes, that lasts until the process is killed.
  std::error_code ignored;
  if (shareSaved_.value_or(false) && (all == kExitDone || all == kExitInterrupted)) fs::remove(emergencyFile_, ignored);
  ranks_->finish();
  return all;
}

}  // namespace wavecrest
