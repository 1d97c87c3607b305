#include "bench/ranks/film_sum.h"

#include <unistd.h>

#include <algorithm>

#include "bench/ranks/sum_tree.h"
#include "engine/chains/epochs.h"
#include "engine/compile/compiled_scene.h"
#include "engine/plan/render_plan.h"
#include "engine/state/state_stream.h"

namespace wavecrest {
namespace {

// What chains have done, as a contribution has it.
void saveChains(StateWriter& out, const ChainStatistics& chains) {
  static_assert(sizeof(ChainCounters) == (2 * kMutationKinds + 4) * sizeof(uint64_t), "padding would be sent");
  static_assert(sizeof(LargeStepSums) == 3 * LargeStepSums::kLengths * sizeof(double), "padding would be sent");
  static_assert(sizeof(StuckChain) == 4 * sizeof(uint32_t), "padding would be sent");
  out.value(chains.mutations);
  out.value(chains.directPaths);
  out.value(chains.epochs);
  out.value(chains.counters);
  out.value(chains.largeSteps);
  out.list(chains.stuck);
}

void addSavedChains(ChainStatistics& sum, StateReader& in) {
  sum.mutations += in.value<uint64_t>();
  sum.directPaths += in.value<uint64_t>();
  sum.epochs = std::max(sum.epochs, in.value<uint64_t>());
  sum.counters += in.value<ChainCounters>();
  sum.largeSteps += in.value<LargeStepSums>();
  const auto stuck = in.list<StuckChain>();
  sum.stuck.insert(sum.stuck.end(), stuck.begin(), stuck.end());
}

// What a contribution has besides pixels, or a little more.
constexpr size_t kRest = 1 << 16;
constexpr size_t kSplatBytes = 3 * sizeof(__int128);  // of a pixel

// Bytes of a film's state, or a little more.
size_t stateBytes(const Film& film) {
  return film.bytes() + (film.hasSplats() ? film.area().size() * kSplatBytes : 0) + kRest;
}

// The same of a film that is not there yet, or a little more: as if chains had a direct pass, and trials chose splats.
uint64_t stateBytes(const Scene& scene, const RenderSettings& settings) {
  const FilmSettings& film = settings.filmOf(scene);
  const FilmArea area = filmOutline(film);
  const CameraView camera = compileCamera(scene.sensor, film);
  const bool spreads = settings.filterMode == FilterMode::spread && canSpread(camera);
  const bool chains = settings.method == Method::mlt, splats = chains || strategiesOf(settings.method).camera;
  const uint64_t ofPixel = sizeof(uint64_t) + (spreads ? 0 : 3 * sizeof(double)) + (splats ? kSplatBytes : 0);
  return area.bytes() + area.size() * ofPixel + (spreads ? SpreadSums::bytesFor(camera, area) : 0) +
         (chains ? settings.metropolis.chains * sizeof(PendingSplat) : 0) + kRest;
}

}  // namespace

nlohmann::ordered_json ProcessRecord::toJson() const {
  return {{"rank", rank},
          {"host", host},
          {"threads", threads},
          {"camera_paths", paths},
          {"light_paths", lightPaths},
          {"render_seconds", renderSeconds},
          {"cpu_seconds", cpuSeconds},
          {"contributions", contributions},
          {"contributing_seconds", contributingSeconds},
          {"adding_seconds", addingSeconds}};
}

ProcessRecord recordOf(uint32_t rank, uint32_t threads, const RenderStatistics& statistics) {
  ProcessRecord record{.rank = rank,
                       .threads = threads,
                       .paths = statistics.paths,
                       .lightPaths = statistics.lightPaths,
                       .renderSeconds = statistics.renderSeconds,
                       .renderWallSeconds = statistics.renderWallSeconds,
                       .cpuSeconds = statistics.cpuSeconds};
  gethostname(record.host, sizeof(record.host) - 1);
  return record;
}

std::vector<unsigned char> contributionOf(const Session& session, const ProcessRecord& record, size_t head) {
  static_assert(sizeof(ProcessRecord) == 2 * sizeof(uint32_t) + 8 * sizeof(uint64_t) + 64, "padding would be sent");
  const auto save = [&](StateWriter& out) {
    const RenderStatistics statistics = session.statistics();
    out.list(std::vector<ProcessRecord>{record});
    WorkDone::of(statistics).save(out);
    saveChains(out, statistics.chains.value_or(ChainStatistics{}));
    session.film().save(out);
  };
  return savedBytes(save, head, stateBytes(session.film()));
}

uint64_t bytesOfSums(const Scene& scene, const RenderSettings& settings, uint32_t ranks) {
  // The first process has the most children, one more than any other at least, and sends no sum on.
  return (2 + SumTree(0, ranks).children().size()) * stateBytes(scene, settings);
}

void FilmSum::sumUp(const std::vector<Bytes>& contributions, const std::function<void()>& added) {
  for (size_t i = 0; i < contributions.size(); ++i) {
    add(contributions[i], i == 0);
    if (added) added();
  }
  std::sort(processes_.begin(), processes_.end(), [](const auto& a, const auto& b) { return a.rank < b.rank; });
}

void FilmSum::add(Bytes contribution, bool first) {
  StateReader in(contribution);
  if (first) {
    processes_.clear();
    chains_ = {};
  }
  const auto processes = in.list<ProcessRecord>();
  processes_.insert(processes_.end(), processes.begin(), processes.end());
  WorkDone work;
  work.restore(in);
  addSavedChains(chains_, in);
  if (!first) {
    work_ += work;
    film_->addSaved(in);
    return;
  }
  work_ = std::move(work);
  if (film_) {
    film_->restore(in);
  } else {
    film_ = Film::fromState(in);
  }
}

std::vector<unsigned char> FilmSum::contribution(size_t head) const {
  const auto save = [&](StateWriter& out) {
    out.list(processes_);
    work_.save(out);
    saveChains(out, chains_);
    film_->save(out);
  };
  return savedBytes(save, head, stateBytes(*film_));
}

RenderStatistics FilmSum::statistics(RenderStatistics own) const {
  own.paths = work_.paths;
  own.lightPaths = work_.lightPaths;
  own.counters = work_.counters;
  own.cpuSeconds = work_.cpuSeconds;
  for (size_t i = 0; i < own.stages.size() && i < work_.stages.size(); ++i) {
    own.stages[i].items = work_.stages[i].items;
    own.stages[i].laneSlots = work_.stages[i].laneSlots;
    own.stages[i].seconds = work_.stages[i].seconds;
  }
  for (const ProcessRecord& process : processes_) {
    own.renderSeconds = std::max(own.renderSeconds, process.renderSeconds);
    own.renderWallSeconds = std::max(own.renderWallSeconds, process.renderWallSeconds);
  }
  if (!own.chains) {
    own.iterations = film_->minSamples();
    return own;
  }
  ChainStatistics& chains = *own.chains;
  chains.mutations = chains_.mutations;
  chains.directPaths = chains_.directPaths;
  chains.epochs = chains_.epochs;
  chains.counters = chains_.counters;
  // Each process has traced all bootstraps, and large steps of its own chains.
  chains.largeSteps = chains_.largeSteps;
  poolBrightness(chains);
  // The worst of all.
  chains.stuck = chains_.stuck;
  std::sort(chains.stuck.begin(), chains.stuck.end(),
            [](const StuckChain& a, const StuckChain& b) { return a.rejections > b.rejections; });
  if (chains.stuck.size() > kListedStuckChains) chains.stuck.resize(kListedStuckChains);
  // The direct pass deals its samples out: without those of some processes there may be none.
  const bool lacksDirect = chains.directPass && film_->minSamples() == 0;
  own.iterations = lacksDirect ? 0 : chains_.mutations / film_->area().size();
  return own;
}

}  // namespace wavecrest
