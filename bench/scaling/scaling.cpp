#include "bench/scaling/scaling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "bench/against/child_render.h"
#include "bench/scaling/list_schedule.h"
#include "bench/throughput/turns.h"
#include "engine/plan/render_plan.h"
#include "engine/session/render_clock.h"
#include "engine/session/session.h"
#include "engine/state/state_stream.h"
#include "engine/tasks/task_recorder.h"

namespace wavecrest {
namespace {

constexpr size_t kRounds = kVisitsForInterval;
// Predictions are of renders of this length: at the end of a short one threads run out of tasks.
constexpr double kPredictedSeconds = 1;
constexpr size_t kMostScheduledTasks =
    1 << 18;  // but no more tasks than this, or prediction would take longer than rendering
// Parts of the time.
constexpr double kMeasuredPart = 0.5, kProcessPart = 0.2, kRecordedPart = 0.3;

// from, 2 from, 4 from, ... below `most`, and `most` itself; nothing if `most` is below `from`.
std::vector<uint32_t> powersOfTwo(uint32_t from, uint32_t most) {
  std::vector<uint32_t> counts;
  for (uint32_t n = from; n < most; n *= 2) counts.push_back(n);
  if (from <= most) counts.push_back(most);
  return counts;
}

// One render on one thread, cut for others, that is recorded slice by slice.
class RecordedRender {
 public:
  RecordedRender(const Scene& scene, const RenderSettings& settings, uint32_t cutFor, double sliceSeconds)
      : threads_(cutFor), session_(Session::create(scene, cutSettings(settings, cutFor))), slices_(*session_) {
    slices_.fill(sliceSeconds);
  }
  uint32_t threads() const { return threads_; }

  void record() {
    TaskRecorder recorder;
    const Slice slice = slices_.render();
    const TaskGraph graph = recorder.graph();
    tasks_ = taskCount(graph);
    // The slice is repeated until every thread has work for kPredictedSeconds, within the limit of tasks.
    const auto most = static_cast<double>(std::max<size_t>(kMostScheduledTasks / tasks_, 1));
    const double wanted = std::ceil(kPredictedSeconds * threads_ / workOf(graph));
    const auto times = static_cast<uint32_t>(std::clamp(wanted, 1.0, most));
    // Predicted rate of the repeated slice.
    rates_.push_back(static_cast<double>(slice.paths) * times / scheduledSeconds(graph, threads_, times));
    parallelisms_.push_back(workOf(graph, times) / spanOf(graph, times));
    longest_ = longestTask(graph);
  }
  // oneThread: paths per second of each round.
  PredictedScaling result(const std::vector<double>& oneThread) const {
    std::vector<double> speedups = rates_;
    for (size_t i = 0; i < speedups.size(); ++i) speedups[i] /= oneThread[i];
    return {.threads = threads_,
            .tasks = tasks_,
            .longestTask = longest_,
            .parallelism = estimateMedian(parallelisms_),
            .speedup = estimateMedian(speedups)};
  }

 private:
  // Work for one thread, in pieces as for cutFor threads.
  static RenderSettings cutSettings(RenderSettings settings, uint32_t cutFor) {
    settings.threads = 1;
    settings.piecesForThreads = cutFor;
    return settings;
  }

  uint32_t threads_;
  std::unique_ptr<Session> session_;
  SliceRenderer slices_;
  std::vector<double> rates_, parallelisms_;  // of each round
  size_t tasks_ = 0;
  double longest_ = 0;
};

// Measures what a part of this render is: its bytes, and the time to read it, to make its image, from which the error
// is estimated, and to add it. All machines' parts are alike; of mlt each has its share of the chains.
std::vector<PartsScaling> partsScaling(const Session& session) {
  constexpr int kRepetitions = 3;
  const std::vector<unsigned char> state = savedBytes([&](StateWriter& out) { session.save(out); });
  const auto filmOf = [&] {
    StateReader in(state);
    return Film::fromState(in);
  };
  const size_t film = savedBytes([&](StateWriter& out) { session.film().save(out); }).size();
  const size_t shared = session.statistics().chains ? state.size() - film : 0;
  const std::unique_ptr<Film> sum = filmOf();
  std::vector<double> seconds;
  for (int i = 0; i < kRepetitions; ++i) {
    const auto begin = Clock::now();
    const std::unique_ptr<Film> part = filmOf();
    part->resolve();
    sum->add(*part);
    seconds.push_back(secondsSince(begin));
  }
  std::vector<PartsScaling> rows;
  for (const uint32_t machines : powersOfTwo(2, kMostPredictedMachines)) {
    rows.push_back({.machines = machines,
                    .bytes = machines * (state.size() - shared) + shared,
                    .mergeSeconds = machines * median(seconds)});
  }
  return rows;
}

}  // namespace

ChildRequest processRequest(const Scene& scene, const std::filesystem::path& file, Method method, uint64_t iterations) {
  const FilmSettings& film = scene.film;
  // A size would take the place of a crop window, and the scene as loaded has one by its file alone.
  return {.scene = file,
          .method = std::string(toString(method)),
          .size = film.isCropped() ? std::string() : fmt::format("{}x{}", film.width, film.height),
          .iterations = iterations,
          .more = {},
          .imageFile = {}};
}

ScalingResult measureScaling(const Scene& scene, const std::filesystem::path& file, RenderSettings settings,
                             double seconds) {
  // Threads render as `render` does by default, because the processes do.
  takeProgramDefaults(settings);
  settings.sampler = bestSampler(settings);
  const FilmArea area = filmArea(scene.film);
  ScalingResult result;
  result.scene = scene.name;
  result.method = settings.method;
  result.width = area.width;
  result.height = area.height;

  // A session for each number of threads that is measured.
  const std::vector<uint32_t> measured = powersOfTwo(1, settings.threads);
  std::vector<std::unique_ptr<Session>> sessions;
  for (const uint32_t threads : measured) {
    RenderSettings own = settings;
    own.threads = threads;
    sessions.push_back(Session::create(scene, own));
  }
  // A recorded render for each number of threads that is predicted.
  const std::vector<uint32_t> predicted = powersOfTwo(2, kMostPredictedThreads);
  const double recordedSlice = kRecordedPart * seconds / static_cast<double>(predicted.size() * (kRounds + 1));
  std::vector<RecordedRender> recorded;
  recorded.reserve(predicted.size());
  for (const uint32_t threads : predicted) recorded.emplace_back(scene, settings, threads, recordedSlice);

  // Each round measures a slice of every session and records a slice of every recorded render.
  MachineWatch watch;
  const TurnPlan plan{.seconds = kMeasuredPart * seconds, .fewestRounds = kRounds, .mostRounds = kRounds};
  const std::vector<std::vector<Slice>> slices = renderInTurn(sessions, plan, [&] {
    for (RecordedRender& render : recorded) render.record();
    watch.look();
  });
  // Predicted speedups are over the measured rate of one thread in the same round.
  const auto ratesOf = [](const std::vector<Slice>& all) {
    return valuesOf(all, [](const Slice& slice) { return slice.pathsPerSecond(); });
  };
  const std::vector<double> oneThread = ratesOf(slices.front());
  for (const RecordedRender& render : recorded) result.predicted.push_back(render.result(oneThread));

  // Processes render as many iterations as one thread does in their part of the time.
  const double oneRate = median(oneThread),
               processSeconds = kProcessPart * seconds / static_cast<double>(measured.size());
  const double iterations = processSeconds * oneRate / static_cast<double>(area.pixels.size());
  const ChildRequest request =
      processRequest(scene, file, settings.method, std::max<uint64_t>(1, static_cast<uint64_t>(iterations)));
  // Measured speedups of threads, and of as many processes.
  double oneProcess = 0;
  for (size_t i = 0; i < measured.size(); ++i) {
    std::vector<double> rates = ratesOf(slices[i]), speedups = rates;
    for (size_t k = 0; k < speedups.size(); ++k) speedups[k] /= oneThread[k];
    const double processes = rateOfProcesses(measured[i], request);
    if (i == 0) oneProcess = processes;
    result.measured.push_back({.threads = measured[i],
                               .pathsPerSecond = estimateMedian(rates),
                               .speedup = estimateMedian(speedups),
                               .processSpeedup = processes / oneProcess});
    watch.look();
  }
  result.parts = partsScaling(*sessions.front());
  result.machine = watch.state();
  return result;
}

}  // namespace wavecrest
