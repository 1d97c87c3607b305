#include "engine/session.h"

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/flow_graph.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>
#include <sys/resource.h>

#include <algorithm>

#include "engine/flush_to_zero.h"
#include "engine/render_plan.h"

namespace wavecrest {
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

double processCpuSeconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

// TBB gives an arena of more threads than the machine has cores no workers for the surplus unless it is told to. Only
// while a session works: the least of all limits alive counts, and several sessions may be.
struct WorkerLimit {
  explicit WorkerLimit(size_t threads) : control(oneapi::tbb::global_control::max_allowed_parallelism, threads) {}
  oneapi::tbb::global_control control;
};

// The part of a session that depends on the storage type of its precision.
template <class S>
class TypedSession final : public Session {
 public:
  TypedSession(const Scene& scene, const RenderSettings& settings)
      : settings_(settings), arena_(static_cast<int>(settings.threads)), film_(filmArea(scene.film)) {
    const auto begin = Clock::now();
    const WorkerLimit limit(settings.threads);
    arena_.execute([&] { plan_ = planRender<S>(scene, settings); });
    const size_t pixels = film_.area().pixels.size();
    waves_.resize((pixels + settings.waveSize - 1) / settings.waveSize);
    buildSeconds_ = secondsSince(begin);
  }

  void renderUntil(std::optional<uint64_t> iterations, std::optional<double> seconds) override;
  RenderStatistics statistics() const override;
  const Film& film() const override { return film_; }
  double progressSeconds() const override { return progressSeconds_.load(std::memory_order_relaxed); }
  uint64_t progressPaths() const override { return progressPaths_.load(std::memory_order_relaxed); }

 private:
  // What one worker thread keeps from wave to wave; nothing is allocated while waves run.
  struct Worker {
    Wave<S> wave;
    StageCounters counters;
    std::vector<StageTally> tallies;
    uint64_t paths = 0;
    Worker(size_t waveSize, const ColumnNeeds& needs, size_t stages) : wave(waveSize, needs), tallies(stages) {}
  };

  // One iteration of one wave. Iterations of the same wave never overlap and come in order.
  void trace(size_t waveIndex, Worker& worker);

  const RenderSettings settings_;
  oneapi::tbb::task_arena arena_;
  Film film_;
  RenderPlan<S> plan_;
  std::vector<uint64_t> waves_;  // iterations done by each wave
  oneapi::tbb::enumerable_thread_specific<std::unique_ptr<Worker>> workers_;
  double buildSeconds_ = 0, renderSeconds_ = 0, cpuSeconds_ = 0;
  std::atomic<double> progressSeconds_{0};
  std::atomic<uint64_t> progressPaths_{0};
};

template <class S>
void TypedSession<S>::trace(size_t waveIndex, Worker& worker) {
  const FlushToZero flushToZero;
  Wave<S>& wave = worker.wave;
  const auto& pixels = film_.area().pixels;
  wave.firstPath = waveIndex * settings_.waveSize;
  wave.pathCount = std::min<size_t>(settings_.waveSize, pixels.size() - wave.firstPath);
  StageContext<S> context{.scene = &plan_.scene->view,
                          .pixels = pixels.data(),
                          .sampler = {settings_.sampler, settings_.seed, static_cast<uint32_t>(waves_[waveIndex])},
                          .limits = settings_.limits,
                          .depth = 0,
                          .counters = &worker.counters};
  runWave(plan_.pipeline, context, wave, settings_.measureStages ? worker.tallies.data() : nullptr);
  worker.counters.nonFinite += film_.add(wave);
  worker.paths += wave.pathCount;
  progressPaths_.fetch_add(wave.pathCount, std::memory_order_relaxed);
  ++waves_[waveIndex];
}

template <class S>
void TypedSession<S>::renderUntil(std::optional<uint64_t> iterations, std::optional<double> seconds) {
  const auto begin = Clock::now();
  const double cpuBegin = processCpuSeconds();
  const WorkerLimit limit(settings_.threads);
  const auto finished = [&](size_t wave) {
    if (iterations && waves_[wave] >= *iterations) return true;
    const double now = renderSeconds_ + secondsSince(begin);
    progressSeconds_.store(now, std::memory_order_relaxed);
    return (seconds && now >= *seconds) || interrupted();
  };

  arena_.execute([&] {
    // The graph has a token per wave. A token that has traced its iteration goes back to the queue, behind all others,
    // so that waves advance together; the run ends when none is put back.
    using oneapi::tbb::flow::continue_msg;
    oneapi::tbb::flow::graph graph;
    oneapi::tbb::flow::queue_node<size_t> ready(graph);
    oneapi::tbb::flow::function_node<size_t, continue_msg, oneapi::tbb::flow::rejecting> tracing(
        graph, settings_.threads, [&](size_t wave) {
          std::unique_ptr<Worker>& worker = workers_.local();
          if (!worker) {
            worker = std::make_unique<Worker>(settings_.waveSize, plan_.needs, plan_.pipeline.stageCount());
          }
          if (finished(wave)) return continue_msg();
          trace(wave, *worker);
          if (!finished(wave)) ready.try_put(wave);
          return continue_msg();
        });
    oneapi::tbb::flow::make_edge(ready, tracing);
    for (size_t wave = 0; wave < waves_.size(); ++wave) ready.try_put(wave);
    graph.wait_for_all();
  });

  renderSeconds_ += secondsSince(begin);
  cpuSeconds_ += processCpuSeconds() - cpuBegin;
  progressSeconds_.store(renderSeconds_, std::memory_order_relaxed);
}

template <class S>
RenderStatistics TypedSession<S>::statistics() const {
  RenderStatistics out;
  out.iterations = film_.minSamples();
  out.buildSeconds = buildSeconds_;
  out.renderSeconds = renderSeconds_;
  out.cpuSeconds = cpuSeconds_;
  out.isa = plan_.isa;
  out.specialization = plan_.specialization;
  out.accel = plan_.accel();
  out.stages.push_back({std::string(plan_.pipeline.generate.name)});
  for (const auto& stage : plan_.pipeline.perDepth) out.stages.push_back({std::string(stage.name)});
  for (const auto& worker : workers_) {
    out.paths += worker->paths;
    out.counters.raysClosest += worker->counters.raysClosest;
    out.counters.raysShadow += worker->counters.raysShadow;
    out.counters.misses += worker->counters.misses;
    out.counters.nonFinite += worker->counters.nonFinite;
    out.bytesPerPath = worker->wave.bytesPerPath();
    for (size_t i = 0; i < out.stages.size(); ++i) {
      out.stages[i].items += worker->tallies[i].items;
      out.stages[i].laneSlots += worker->tallies[i].laneSlots;
      out.stages[i].seconds += static_cast<double>(worker->tallies[i].ticks) * secondsPerTick();
    }
  }
  return out;
}

}  // namespace

std::unique_ptr<Session> Session::create(const Scene& scene, const RenderSettings& settings) {
  if (settings.precision == Precision::doubled) return std::make_unique<TypedSession<double>>(scene, settings);
  return std::make_unique<TypedSession<float>>(scene, settings);
}

}  // namespace wavecrest
