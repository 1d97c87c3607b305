// The benchmarks of the kernels room; each function registers those of one source.
#pragma once

namespace wavecrest {

void registerSamplerBenchmarks();  // sampler_bench.cpp
void registerMathBenchmarks();     // math_bench.cpp

}  // namespace wavecrest
