// What the parts of stages_bench share: registration with manual time, and the counters that every benchmark reports.
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <string>

namespace wavecrest {

void registerStageBenchmarks();          // walk_bench.cpp
void registerCrossoverBenchmarks();      // crossover_bench.cpp
void registerBidirectionalBenchmarks();  // bidirectional_bench.cpp
void registerInstanceBenchmarks();       // instances_bench.cpp

// Times are set by the benchmark itself (SetIterationTime). The minimum over repetitions is the figure that other
// programs on the machine disturb least.
template <class Function>
void registerBenchmark(const std::string& name, Function&& function) {
  benchmark::RegisterBenchmark(name.c_str(), std::forward<Function>(function))
      ->UseManualTime()
      ->Unit(benchmark::kMicrosecond)
      ->ComputeStatistics("min", [](const std::vector<double>& v) { return *std::min_element(v.begin(), v.end()); });
}

// items: worked on in one iteration.
inline void reportItems(benchmark::State& state, size_t items) {
  using benchmark::Counter;
  state.SetItemsProcessed(static_cast<int64_t>(items) * static_cast<int64_t>(state.iterations()));
  state.counters["items"] = static_cast<double>(items);
  state.counters["per_item"] =  // seconds; the console shows 9.7n
      Counter(static_cast<double>(items), Counter::kIsIterationInvariantRate | Counter::kInvert);
}

}  // namespace wavecrest
