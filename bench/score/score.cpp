#include "bench/score/score.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>

#include "bench/against/child_render.h"
#include "bench/film_image.h"
#include "bench/throughput/turns.h"
#include "engine/load/load.h"
#include "metrics/image/image_io.h"
#include "metrics/rmse.h"

namespace wavecrest {
namespace {

// Of kScoreSlices: those that are timed on one thread, between one that warms caches up and one whose events are
// counted; and those of each process.
constexpr uint64_t kThreadSlices = 6, kProcessSlices = 1;
static_assert(kThreadSlices >= kVisitsForInterval,
              "the range of fewer holds the median less often than kIntervalLevel");
static_assert(kThreadSlices + 2 <= kScoreSlices);

Scene loadEntry(const ScoreRequest& request, const ScoreEntry& entry) {
  return loadScene(request.sceneFile(entry.scene), {.filmSize = std::array{entry.width, entry.height}});
}

// Time, samples and relMSE of the render so far.
QualityAtTime qualityNow(const Session& session, const Image& reference) {
  const RenderStatistics now = session.statistics();
  return {.seconds = now.renderSeconds,
          .cpuSeconds = now.cpuSeconds,
          .samplesPerPixel = static_cast<double>(now.paths) / static_cast<double>(session.film().area().pixels.size()),
          .relmse = relmse(reference, reduced(filmImage(session), reference.width)).relmse};
}

// Renders the workload on all threads, slice by slice. judge: what the image after the first one is.
void renderOnThreads(const Scene& scene, const RenderSettings& settings, const Image& reference,
                     const std::function<ImageVerdict(const Image&)>& judge, ScoreRow& row) {
  const auto session = Session::create(scene, settings);
  SliceRenderer slices(*session, row.entry.iterations / kScoreSlices);
  std::vector<double> rates;
  for (uint64_t done = 1; done <= kScoreSlices; ++done) {
    rates.push_back(slices.render().pathsPerSecond());
    if (done == 1) row.image = judge(filmImage(*session));
    // After slices 1, 2, 4 and 8.
    if ((done & (done - 1)) == 0) row.quality.push_back(qualityNow(*session, reference));
  }
  row.pathsPerSecond = estimateMedian(rates);
}

ScoreRow measureRow(const ScoreRequest& request, const ScoreEntry& entry, const ExpectedImages& expected) {
  const Scene scene = loadEntry(request, entry);
  const RenderSettings settings = scoreSettings(scene, entry, request.isa, request.threads);
  const Image reference = readImage(request.references / (entry.scene + ".exr")).image;
  ScoreRow row;
  row.entry = entry;
  // All threads: speed, quality over time, and the image that validates the row.
  const auto judge = [&](const Image& film) { return judgeImage(film, request.size, request.isa, entry, expected); };
  renderOnThreads(scene, settings, reference, judge, row);
  // One thread.
  measureOneThread(scene, settings, kHardwareEvents, row);
  // As many processes as threads, on one thread each, for one slice.
  const ChildRequest child{.scene = request.sceneFile(entry.scene),
                           .method = std::string(toString(entry.method)),
                           .size = fmt::format("{}x{}", entry.width, entry.height),
                           .iterations = kProcessSlices * entry.iterations / kScoreSlices,
                           .more = optionsOf(settings),
                           .imageFile = {}};
  row.processesPathsPerSecond = rateOfProcesses(request.threads, child);
  // Both scores are relative to one thread of the reference machine, which has 100.
  const double rate = referenceMachine().rateOf(entry);
  row.score = 100 * row.pathsPerSecond.value / rate;
  row.coreScore = 100 * row.pathsPerCpuSecond.value / rate;
  return row;
}

// Geometric mean of a figure over the rows of a method, or of all methods; 0 without rows.
double geometricMean(const std::vector<ScoreRow>& rows, std::optional<Method> method, double ScoreRow::*figure) {
  double sum = 0, count = 0;
  for (const ScoreRow& row : rows) {
    if (method && row.entry.method != *method) continue;
    sum += std::log(row.*figure);
    ++count;
  }
  return count > 0 ? std::exp(sum / count) : 0;
}

}  // namespace

void measureOneThread(const Scene& scene, RenderSettings settings, const std::array<PerfEvent, kStageEvents>& events,
                      ScoreRow& row) {
  settings.threads = 1;
  settings.measureStages = true;
  const auto session = Session::create(scene, settings);
  SliceRenderer renderer(*session, row.entry.iterations / kScoreSlices);
  // The first slice warms caches up; its time is not used.
  renderer.render();
  // Speed of the later slices. A counter reads its events around every stage, which takes CPU time.
  assert(stageObserver == nullptr);
  std::vector<Slice> slices;
  for (uint64_t i = 0; i < kThreadSlices; ++i) slices.push_back(renderer.render());
  row.pathsPerCpuSecond = estimateMedian(valuesOf(slices, [](const Slice& s) { return s.pathsPerCpuSecond(); }));
  row.facts = session->statistics();
  // Events of one slice more, where they can be counted.
  StageEventCounter counter(events);
  Slice counted;
  if (counter.refusal().empty()) counted = renderer.render();
  const std::map<std::string, StageEvents> sums = counter.take();
  // Stages: shares of time, bytes of columns, and events per item.
  const StageTraffic traffic(scene, settings);
  const std::vector<StageShare> shares = stageShares({slices});
  for (size_t i = 0; i < shares.size(); ++i) {
    ScoredStage& stage = row.stages.emplace_back();
    stage.share = shares[i];
    stage.bytesPerItem = traffic.bytesPerItem(shares[i].name);
    const auto found = sums.find(shares[i].name);
    if (found == sums.end() || counted.stages[i].items == 0) continue;
    for (size_t k = 0; k < kStageEvents; ++k) {
      stage.eventsPerItem[k] = static_cast<double>(found->second[k]) / static_cast<double>(counted.stages[i].items);
    }
  }
}

Image validatedImage(const Scene& scene, const ScoreEntry& entry, Isa isa, uint32_t threads) {
  const auto session = Session::create(scene, scoreSettings(scene, entry, isa, threads));
  session->renderUntil(entry.iterations / kScoreSlices, std::nullopt);
  return filmImage(*session);
}

bool ScoreResult::allAccepted() const {
  return std::all_of(rows.begin(), rows.end(), [](const ScoreRow& row) { return row.image.isAccepted(); });
}

double ScoreResult::score(std::optional<Method> method) const { return geometricMean(rows, method, &ScoreRow::score); }

double ScoreResult::coreScore(std::optional<Method> method) const {
  return geometricMean(rows, method, &ScoreRow::coreScore);
}

std::vector<std::string> ScoreResult::doubts() const {
  std::vector<std::string> doubts = doubtsAbout(machine);
  const auto count = [&](Validity validity) {
    return std::count_if(rows.begin(), rows.end(), [&](const ScoreRow& row) { return row.image.validity == validity; });
  };
  if (const auto refused = count(Validity::refused); refused > 0) {
    doubts.push_back(
        fmt::format("{} of {} images are not what this workload renders: this is no score", refused, rows.size()));
  }
  if (const auto unknown = count(Validity::unknown); unknown > 0) {
    doubts.push_back(fmt::format("{} of {} images could not be validated: neither hashes nor pictures are known for {}",
                                 unknown, rows.size(), hashGroup(isa)));
  }
  return doubts;
}

ScoreResult measureScore(const ScoreRequest& request, const ExpectedImages& expected,
                         const std::function<void(const ScoreRow&)>& progress) {
  ScoreResult result;
  result.size = request.size;
  result.isa = request.isa;
  result.threads = request.threads;
  result.ceilings = measureCeilings(request.isa);
  result.eventsRefusal = StageEventCounter().refusal();
  MachineWatch watch;
  for (const ScoreEntry& entry : request.entries) {
    result.rows.push_back(measureRow(request, entry, expected));
    progress(result.rows.back());
    watch.look();
  }
  result.machine = watch.state();
  return result;
}

}  // namespace wavecrest
