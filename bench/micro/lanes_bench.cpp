// Microbenchmarks of the kernels on each instruction set. To compare a change with its base on the same machine, run
// both builds in turn with --benchmark_enable_random_interleaving=true --benchmark_repetitions=9, which spreads the
// repetitions over the run so that clock and neighbours change for all alike.
#include "bench/micro/lanes_bench.h"

#include <benchmark/benchmark.h>

int main(int argc, char** argv) {
  wavecrest::registerSamplerBenchmarks();
  wavecrest::registerMathBenchmarks();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
