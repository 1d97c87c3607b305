// Time of each metric on 1024x768 images against a prepared reference: what one snapshot of a campaign costs.
//
// Every benchmark first checks its score against the golden figure of the pair it measures; a wrong result is an error,
// not a time. TBB spreads the work over all cores: the CPU column
// is the time of all threads together, the first column the wall time of one comparison.
#include <benchmark/benchmark.h>
#include <kissfft/kiss_fft.h>

#include <cmath>
#include <ctime>
#include <string>
#include <vector>

#include "metrics/cvvdp/cvvdp.h"
#include "metrics/flip.h"
#include "metrics/hdrvdp2/hdrvdp2.h"
#include "metrics/ms_ssim.h"
#include "metrics/planes/fft.h"
#include "metrics/planes/plane.h"
#include "metrics/pu21.h"
#include "metrics/ssim.h"
#include "tests/metrics/golden.h"

namespace wavecrest {
namespace {

const test::GoldenPair& roomPair() { return test::goldenPairs().back(); }  // p5_room_1024x768

bool checkScore(benchmark::State& state, double score, double golden, double tolerance) {
  if (std::abs(score - golden) <= tolerance) return true;
  state.SkipWithError(("score " + std::to_string(score) + " is not the golden " + std::to_string(golden)).c_str());
  return false;
}

// CPU seconds that the usual program takes for the same pair, the least that bench/peers/metrics saw. Ratios of one run
// of that script mean more: it lets the programs take turns.
constexpr double kScikitImageSeconds = 0.56;    // scikit-image 0.26, structural_similarity, three channels
constexpr double kFlipEvaluatorSeconds = 1.52;  // flip-evaluator 1.7, evaluate(..., "LDR")
constexpr double kOctaveHdrVdpSeconds = 4.5;    // the original HDR-VDP-2.2 under GNU Octave 7.3, second call

// CPU seconds of this process, all threads together.
double processCpuSeconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// Runs the comparison: pixels per second, and CPU seconds of the usual program over ours, where one was timed.
template <class Compare>
void measure(benchmark::State& state, Compare&& compare, double usualSeconds = 0) {
  const double begin = processCpuSeconds();
  for (auto _ : state) compare();
  const double spent = processCpuSeconds() - begin;
  if (usualSeconds > 0) {
    state.counters["times_faster"] = usualSeconds * static_cast<double>(state.iterations()) / spent;
  }
  state.SetItemsProcessed(static_cast<int64_t>(state.iterations()) *
                          static_cast<int64_t>(roomPair().test.pixelCount()));
}

void ssim(benchmark::State& state) {
  const auto& pair = roomPair();
  const PreparedSsim prepared(pair.reference);
  const double golden = test::goldenFigure("ssim.json", pair.name, "ssim_mean");
  if (!checkScore(state, prepared.compare(pair.test).mean, golden, 1e-6)) return;
  measure(
      state, [&] { benchmark::DoNotOptimize(prepared.compare(pair.test).mean); }, kScikitImageSeconds);
}
BENCHMARK(ssim)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

void flip(benchmark::State& state) {
  const auto& pair = roomPair();
  const PreparedFlip prepared(pair.reference);
  const double golden = test::goldenFigure("flip.json", pair.name, "flip_map_mean_double");
  if (!checkScore(state, prepared.compare(pair.test).mean, golden, 2e-5)) return;
  measure(
      state, [&] { benchmark::DoNotOptimize(prepared.compare(pair.test).mean); }, kFlipEvaluatorSeconds);
}
BENCHMARK(flip)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

void hdrvdp2(benchmark::State& state) {
  const auto& pair = roomPair();
  const PreparedHdrVdp2 prepared(pair.reference);
  const double golden = test::goldenFigure("hdrvdp2.json", pair.name, "Q");
  if (!checkScore(state, prepared.compare(pair.test).q, golden, 1e-4)) return;
  measure(
      state, [&] { benchmark::DoNotOptimize(prepared.compare(pair.test).q); }, kOctaveHdrVdpSeconds);
}
BENCHMARK(hdrvdp2)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

void msssim(benchmark::State& state) {
  const auto& pair = roomPair();
  const PreparedMsSsim prepared(pair.reference);
  const double golden = test::goldenFigure("msssim.json", pair.name, "wang_mean");
  if (!checkScore(state, prepared.compare(pair.test).mean, golden, 1e-6)) return;
  measure(state, [&] { benchmark::DoNotOptimize(prepared.compare(pair.test).mean); });
}
BENCHMARK(msssim)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

void pu21(benchmark::State& state) {
  const auto& pair = roomPair();
  const PreparedPu21 prepared(test::lightOf(pair.reference));
  const Image test = test::lightOf(pair.test);
  if (!checkScore(state, prepared.psnr(test).colour, test::goldenFigure("pu21.json", pair.name, "psnr"), 1e-4)) return;
  if (!checkScore(state, prepared.ssim(test).mean, test::goldenFigure("pu21.json", pair.name, "ssim"), 1e-4)) return;
  measure(state, [&] {
    benchmark::DoNotOptimize(prepared.psnr(test).colour);
    benchmark::DoNotOptimize(prepared.ssim(test).mean);
  });
}
BENCHMARK(pu21)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

void cvvdp(benchmark::State& state) {
  const auto& pair = roomPair();
  const PreparedCvvdp prepared(pair.reference);
  if (!checkScore(state, prepared.compare(pair.test).jod, test::goldenFigure("cvvdp.json", pair.name, "jod"), 1e-4))
    return;
  measure(state, [&] { benchmark::DoNotOptimize(prepared.compare(pair.test).jod); });
}
BENCHMARK(cvvdp)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

// Sixteen complex transforms of the row length of a 1024-pixel image, batched and one by one with kissfft.
constexpr size_t kLength = 2048;

void fftBatch(benchmark::State& state) {
  const FftPlan plan(kLength);
  AlignedArray<float> data(kLength * kFftElement), work(plan.workFloats());
  for (auto _ : state) {
    plan.transform(data.data(), work.data(), FftDirection::forward);
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(static_cast<int64_t>(state.iterations() * kFftBatch));
}
BENCHMARK(fftBatch)->Unit(benchmark::kMicrosecond);

void fftKiss(benchmark::State& state) {
  std::vector<kiss_fft_cpx> in(kLength * kFftBatch), out(in.size());
  kiss_fft_cfg config = kiss_fft_alloc(static_cast<int>(kLength), 0, nullptr, nullptr);
  for (auto _ : state) {
    for (size_t i = 0; i < kFftBatch; ++i) kiss_fft(config, in.data() + i * kLength, out.data() + i * kLength);
    benchmark::ClobberMemory();
  }
  kiss_fft_free(config);
  state.SetItemsProcessed(static_cast<int64_t>(state.iterations() * kFftBatch));
}
BENCHMARK(fftKiss)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace wavecrest
