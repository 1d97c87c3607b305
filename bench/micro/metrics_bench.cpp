// Time of each metric on 1024x768 images against a prepared reference: what one snapshot of a campaign costs.
//
// Every benchmark first checks its score against the golden figure of the pair it measures; a wrong result is an error,
// not a time. TBB spreads the work over all cores: the CPU column
// is the time of all threads together, the first column the wall time of one comparison.
#include <benchmark/benchmark.h>

#include <cmath>
#include <string>

#include "metrics/flip.h"
#include "metrics/hdrvdp2/hdrvdp2.h"
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

void reportPixels(benchmark::State& state) {
  state.SetItemsProcessed(static_cast<int64_t>(state.iterations()) *
                          static_cast<int64_t>(roomPair().test.pixelCount()));
}

void ssim(benchmark::State& state) {
  const auto& pair = roomPair();
  const PreparedSsim prepared(pair.reference);
  const double golden = test::goldenFigures("ssim.json", pair.name)["ssim_mean"];
  if (!checkScore(state, prepared.compare(pair.test).mean, golden, 1e-6)) return;
  for (auto _ : state) benchmark::DoNotOptimize(prepared.compare(pair.test).mean);
  reportPixels(state);
}
BENCHMARK(ssim)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

void flip(benchmark::State& state) {
  const auto& pair = roomPair();
  const PreparedFlip prepared(pair.reference);
  const double golden = test::goldenFigures("flip.json", pair.name)["flip_map_mean_double"];
  if (!checkScore(state, prepared.compare(pair.test).mean, golden, 2e-5)) return;
  for (auto _ : state) benchmark::DoNotOptimize(prepared.compare(pair.test).mean);
  reportPixels(state);
}
BENCHMARK(flip)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

void hdrvdp2(benchmark::State& state) {
  const auto& pair = roomPair();
  const PreparedHdrVdp2 prepared(pair.reference);
  const double golden = test::goldenFigures("hdrvdp2.json", pair.name)["Q"];
  if (!checkScore(state, prepared.compare(pair.test).q, golden, 1e-4)) return;
  for (auto _ : state) benchmark::DoNotOptimize(prepared.compare(pair.test).q);
  reportPixels(state);
}
BENCHMARK(hdrvdp2)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace
}  // namespace wavecrest
