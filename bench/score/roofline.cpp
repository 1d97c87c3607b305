#include "bench/score/roofline.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "bench/machine/cpu_timer.h"
#include "bench/machine/machine_record.h"
#include "bench/score/peak_loops.h"
#include "compiled_isas.h"
#include "engine/plan/render_plan.h"
#include "kernels/columns/memory_block.h"

namespace wavecrest {

// Defined by peak_lanes.cpp, once per compiled instruction set.
#define WAVECREST_DECLARE_LOOPS(NAMESPACE) \
  namespace NAMESPACE {                    \
  const PeakLoops& peakLoops();            \
  }
WAVECREST_DECLARE_LOOPS(N_SCALAR)
WAVECREST_DECLARE_LOOPS(N_SSE4)
WAVECREST_DECLARE_LOOPS(N_AVX2)
WAVECREST_DECLARE_LOOPS(N_AVX3)
#undef WAVECREST_DECLARE_LOOPS

const PeakLoops& peakLoopsOf(Isa isa) {
  switch (isa) {
#ifdef WAVECREST_ISA_SCALAR
    case Isa::scalar:
      return N_SCALAR::peakLoops();
#endif
#ifdef WAVECREST_ISA_SSE4
    case Isa::sse4:
      return N_SSE4::peakLoops();
#endif
#ifdef WAVECREST_ISA_AVX2
    case Isa::avx2:
      return N_AVX2::peakLoops();
#endif
#ifdef WAVECREST_ISA_AVX512
    case Isa::avx512:
      return N_AVX3::peakLoops();
#endif
    default:
      throw std::invalid_argument("no loops were compiled for " + std::string(toString(isa)));
  }
}

namespace {

constexpr size_t kMegabyte = size_t{1} << 20;
constexpr double kTrialSeconds = 0.01;
constexpr int kTrials = 7;  // the best counts: a ceiling is what nothing else held up

// The best rate of `work` per second of CPU time, in trials long enough for the clock.
template <class Run>
double bestRate(double work, Run&& run) {
  CpuTimer timer;
  double best = 0;
  size_t repeats = 1;
  for (int trial = 0; trial < kTrials;) {
    timer.start();
    for (size_t i = 0; i < repeats; ++i) run();
    const double seconds = timer.seconds();
    if (seconds < kTrialSeconds) {
      repeats *= 2;
      continue;
    }
    best = std::max(best, work * static_cast<double>(repeats) / seconds);
    ++trial;
  }
  return best;
}

// Bytes per second of a triad over three columns that have about this many bytes together.
double triadRate(const PeakLoops& loops, size_t bytes) {
  // Whole blocks of 64 floats, a multiple of the lanes of every instruction set.
  const size_t count = std::max<size_t>(bytes / (3 * sizeof(float)) / 64 * 64, 64);
  const MemoryBlock memory(3 * count * sizeof(float), 64);
  auto* const a = reinterpret_cast<float*>(memory.get());
  // The block comes uninitialised. Filling also touches every page before the timing begins.
  std::fill(a, a + 3 * count, 1.0f);
  return bestRate(3.0 * sizeof(float) * static_cast<double>(count),
                  [&] { loops.triad(a, a + count, 0.5f, a + 2 * count, count); });
}

// Queues of a wave, as bits.
enum Queue : uint32_t {
  kRays = 1,
  kHits = 2,
  kSurfaces = 4,
  kPaths = 8,
  kShadowRays = 16,
  kVertexRows = 32,
  kRadiance = 64
};
// The queues that describe a vertex of a path.
constexpr uint32_t kVertex = kRays | kHits | kSurfaces | kPaths;

// The queues that a stage reads and writes, as bits of Queue.
struct Traffic {
  StageId stage;
  uint32_t reads, writes;
};

// From the contracts at the head of the stages' files. Those of Markov chains work on the chains' own state besides,
// and are left out.
constexpr Traffic kTraffic[] = {
    {StageId::generateCameraPaths, 0, kRays | kPaths | kRadiance},
    {StageId::generateLightPaths, 0, kRays | kPaths},
    {StageId::extendSmall, kRays, kHits},
    {StageId::occludeSmall, kShadowRays, kRadiance},
    {StageId::arrive, kRays | kHits | kPaths, kVertex | kRadiance},
    {StageId::scatter, kVertex, kRays | kPaths},
    {StageId::scatterSpecular, kVertex, kRays | kPaths},
    {StageId::nextEvent, kVertex, kShadowRays},
    {StageId::storeLightVertices, kVertex, kVertexRows},
    {StageId::connectToCamera, kVertex, kShadowRays},
    {StageId::connectVertices, kVertex | kVertexRows, kShadowRays},
    {StageId::merge, kVertex | kVertexRows, kRadiance},
};

// Bytes of a record in a queue, without columns that scene and method do not need.
template <class S>
size_t bytesOf(Columns<S>& queue) {
  return queue.bytesPerItem();
}

}  // namespace

Ceilings measureCeilings(Isa isa) {
  const PeakLoops& loops = peakLoopsOf(isa);
  const Topology& topology = machineRecord().topology;
  // Where the cache size is unknown, the second cache is taken to have half a megabyte.
  const size_t l2 = topology.l2Bytes != 0 ? topology.l2Bytes : kMegabyte / 2;
  // Four times the third cache, which cannot keep that much. The limits serve unknown and very large caches.
  const size_t beyond = std::clamp<size_t>(4 * topology.l3Bytes, 64 * kMegabyte, 512 * kMegabyte);
  constexpr size_t kRounds = 10000;
  // Keeps the compiler from dropping the loop.
  volatile float sink = 0;
  return {.cacheBytesPerSecond = triadRate(loops, l2 / 2),
          .memoryBytesPerSecond = triadRate(loops, beyond),
          .operationsPerSecond = bestRate(static_cast<double>(loops.operationsPerRound * kRounds),
                                          [&] { sink = loops.multiplyAdd(0.5f, kRounds); })};
}

StageTraffic::StageTraffic(const Scene& scene, const RenderSettings& settings) {
  const RenderPlan<float> plan = planRender<float>(scene, settings);
  // Bytes per record do not depend on the capacity, so a small wave is enough.
  Wave<float> wave(kColumnPadding, plan.needs);
  rays_ = bytesOf(wave.rays);
  hits_ = bytesOf(wave.hits);
  surfaces_ = bytesOf(wave.surfaces);
  paths_ = bytesOf(wave.paths);
  shadowRays_ = bytesOf(wave.shadowRays);
  vertexRows_ = bytesOf(wave.vertexRows);
  radiance_ = bytesOf(wave.radiance);
}

std::optional<size_t> StageTraffic::bytesPerItem(std::string_view row) const {
  // Rows of several walks have the walk's name after the stage's: the longest title that fits is the stage's.
  const Traffic* found = nullptr;
  size_t length = 0;
  for (const Traffic& traffic : kTraffic) {
    const std::string_view title = infoOf(traffic.stage).title;
    const bool fits = row.starts_with(title) && (row.size() == title.size() || row[title.size()] == ' ');
    if (!fits || title.size() <= length) continue;
    found = &traffic;
    length = title.size();
  }
  if (found == nullptr) return std::nullopt;
  const auto sum = [this](uint32_t queues) {
    size_t bytes = 0;
    // In the order of the bits of Queue.
    const size_t each[] = {rays_, hits_, surfaces_, paths_, shadowRays_, vertexRows_, radiance_};
    for (size_t i = 0; i < std::size(each); ++i) bytes += (queues >> i & 1) != 0 ? each[i] : 0;
    return bytes;
  };
  return sum(found->reads) + sum(found->writes);
}

}  // namespace wavecrest
