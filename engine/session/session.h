// A session: one render of one scene by one method, its clock and its film.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/film/film.h"
#include "engine/learn/guide.h"
#include "engine/plan/memory_use.h"
#include "engine/plan/merge_radius.h"
#include "engine/plan/render_settings.h"
#include "engine/session/method_choice.h"
#include "kernels/columns/chains.h"

namespace wavecrest {

class StateReader;
class StateWriter;

// A chain that has rejected kStuckRejections proposals in a row, or more.
struct StuckChain {
  uint32_t chain = 0;
  uint32_t rejections = 0;
  uint32_t edges = 0;  // of the path it is at; of pssmlt the vertices that draw numbers
  uint32_t pixel = 0;  // of the film's rectangle, row by row
};
constexpr size_t kListedStuckChains = 16;

// What Markov chains have done so far.
struct ChainStatistics {
  uint64_t mutations = 0;    // of all chains, rejected ones included
  bool directPass = false;   // direct light is rendered apart,
  uint64_t directPaths = 0;  // by so many paths
  uint64_t epochs = 0;
  double brightness = 0, brightnessError = 0;  // b, the mean luminance of what chains render, and its standard error
  // b from the bootstraps and all large steps together; too small where chains are bound to lengths and b is uncertain
  // (engine/chains/README.md). The image is scaled by the bootstraps' own, which chains start from.
  double pooledBrightness = 0, pooledError = 0;
  LargeStepSums bootstraps, largeSteps;  // the samples of these
  bool largeStepsOfAnyLength = false;    // in path space chains are bound to no length
  double largestShare =
      0;  // of one bootstrap sample in b, at most over epochs: large where chains start too much alike
  ChainCounters counters;
  std::vector<StuckChain> stuck;  // the worst at the ends of epochs and now
  size_t bytes = 0;               // of the chains' state
};

// Numbers of a render so far, as --stats reports them.
struct RenderStatistics {
  uint64_t iterations = 0;  // whole iterations in the film (the least over pixels)
  // Whether the film is an image: each pixel has a sample, or chains have made as many mutations as there are pixels.
  // Before that it is black in places, which no reader of it can tell from shadow.
  bool hasWholeImage() const { return iterations > 0; }
  uint64_t paths = 0;  // camera paths
  uint64_t lightPaths = 0;
  StageCounters counters;
  double buildSeconds = 0, renderSeconds = 0, cpuSeconds = 0;  // renderSeconds: by the clock of the settings
  double renderWallSeconds = 0;
  struct StageRow {
    std::string name;
    uint64_t items = 0;
    uint64_t laneSlots = 0;  // lanes of the blocks that the items filled; items / laneSlots is the lane use
    double seconds = 0;      // summed over threads
  };
  std::vector<StageRow> stages;
  Isa isa{};
  Specialization specialization{};
  Accel accel{};
  SamplerKind sampler{};                   // of the settings; after trials that of the method they chose
  FilterMode filterMode{};                 // what the film does: boxes and very wide filters are never spread
  size_t bytesPerPath = 0;                 // of a wave's columns
  MemoryUse memory;                        // of all threads that have worked
  std::optional<MergeRadius> mergeRadius;  // of methods that merge
  std::optional<ChainStatistics> chains;   // of mlt
  std::optional<GuideStatistics> guide;    // of gpt
  std::optional<MethodChoice> choice;      // after trials

  // The method whose page is executed, where `asked` is that of the settings.
  Method renderedBy(Method asked) const { return choice ? choice->method : asked; }
};

// The smaller of two limits. An empty value is no limit.
template <class T>
std::optional<T> earlier(std::optional<T> a, std::optional<T> b) {
  return a && b ? std::min(*a, *b) : a ? a : b;
}

class Session {
 public:
  virtual ~Session() = default;

  // Renders until the given iteration count or render time (both counted from the session's beginning) is reached, or
  // interrupt() was called. The clock runs only inside. May be called again to go on.
  virtual void renderUntil(std::optional<uint64_t> iterations, std::optional<double> seconds) = 0;

  // Asks a running renderUntil to return once the waves under way are done. Safe from any thread and signal handler.
  // Sequentially consistent, as resume(): whoever looks for new reasons after a resume() finds those of interrupts that
  // it has taken back.
  void interrupt() { interrupted_.store(true); }
  bool interrupted() const { return interrupted_.load(std::memory_order_relaxed); }
  // Takes an interrupt() back, so that renderUntil goes on.
  void resume() { interrupted_.store(false); }

  virtual RenderStatistics statistics() const = 0;
  virtual const Film& film() const = 0;
  virtual const MemoryPlan& memoryPlan() const = 0;
  // What the render has learned of directions where a pixel of the image looks, x and y counted from its upper left
  // corner; none of methods that learn none, and where a path through the pixel meets no rough surface.
  virtual std::optional<LearnedDirections> learnedDirections(uint32_t /*x*/, uint32_t /*y*/) const {
    return std::nullopt;
  }
  // All that a session of the same scene and settings needs to go on from here, whatever its number of threads and size
  // of waves (engine/session/work_done.h). No renderUntil may be running.
  virtual void save(StateWriter& out) const = 0;
  // Takes over the state that another session saved. Images are from then on the same, bit for bit, as if this session
  // had rendered everything; counts and clocks go on as well, except the time for building. To be called before the
  // first renderUntil. Throws StateError if the state belongs to another render; the session must not be used then.
  virtual void restore(StateReader& in) = 0;

  // Render seconds and camera paths (of mlt: mutations) so far, for progress shown from another thread.
  virtual double progressSeconds() const = 0;
  virtual uint64_t progressPaths() const = 0;

  // Compiles the scene and plans the memory. Throws std::runtime_error where the scene cannot be rendered, and
  // MemoryBudgetError where it does not fit the settings' budget.
  static std::unique_ptr<Session> create(const Scene& scene, const RenderSettings& settings);

 private:
  std::atomic<bool> interrupted_{false};
};

}  // namespace wavecrest
