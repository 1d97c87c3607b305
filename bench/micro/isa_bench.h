// What every kernel benchmark uses: one benchmark per instruction set of this machine, time per item, checked results.
//
// A benchmark runs its kernel on kItems items, small enough for a core's L2, the size of a wave. It compares the result
// with the scalar twin's before it measures: a kernel that computes something else is an error, not a time.
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "kernels/simd/isa_table.h"

namespace wavecrest {

constexpr size_t kItems = 4096;

// Registers "name/scalar", "name/sse4" and so on; run(state, isa) is the benchmark. Called from lanes_bench.cpp, when
// all lane sources have registered their entries.
template <class Run>
void registerForEveryIsa(const std::string& name, Run run) {
  for (const Isa isa : availableIsas()) {
    benchmark::RegisterBenchmark((name + '/' + std::string(toString(isa))).c_str(),
                                 [run, isa](benchmark::State& state) { run(state, isa); });
  }
}

// Items per second and its inverse, and the time of one call on a full register.
inline void reportItems(benchmark::State& state, size_t lanes) {
  using benchmark::Counter;
  const auto items = static_cast<double>(state.iterations()) * static_cast<double>(kItems);
  state.SetItemsProcessed(static_cast<int64_t>(items));
  state.counters["per_item"] = Counter(items, Counter::kIsRate | Counter::kInvert);
  state.counters["per_block"] = Counter(items / static_cast<double>(lanes), Counter::kIsRate | Counter::kInvert);
}

// Equal up to `tolerance`, relative to values above 1 and absolute below; otherwise the benchmark fails and the answer
// is false.
template <class T>
bool checkAgainstTwin(benchmark::State& state, const std::vector<T>& actual, const std::vector<T>& twin, T tolerance) {
  for (size_t i = 0; i < actual.size(); ++i) {
    if (std::abs(actual[i] - twin[i]) <= tolerance * std::max(T(1), std::abs(twin[i]))) continue;
    state.SkipWithError(("item " + std::to_string(i) + " is " + std::to_string(actual[i]) + ", the scalar twin's is " +
                         std::to_string(twin[i]))
                            .c_str());
    return false;
  }
  return true;
}

}  // namespace wavecrest
