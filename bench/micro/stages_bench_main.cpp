// stages_bench: microbenchmarks of the stages. Repetitions run in random order across all benchmarks, so that a
// disturbance of the machine meets them alike; arguments of the command line come last and win.
#include <benchmark/benchmark.h>
#include <pmmintrin.h>
#include <xmmintrin.h>

#include <vector>

#include "bench/micro/registration.h"

int main(int argc, char** argv) {
  std::vector<std::string> defaults{"--benchmark_enable_random_interleaving=true", "--benchmark_repetitions=5",
                                    "--benchmark_min_time=0.02", "--benchmark_display_aggregates_only=true"};
  std::vector<char*> arguments{argv[0]};
  for (std::string& argument : defaults) arguments.push_back(argument.data());
  arguments.insert(arguments.end(), argv + 1, argv + argc);
  int count = static_cast<int>(arguments.size());

  _mm_setcsr(_mm_getcsr() | _MM_FLUSH_ZERO_ON | _MM_DENORMALS_ZERO_ON);  // as in a session
  wavecrest::registerStageBenchmarks();
  wavecrest::registerCrossoverBenchmarks();
  wavecrest::registerBidirectionalBenchmarks();
  wavecrest::registerInstanceBenchmarks();
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
