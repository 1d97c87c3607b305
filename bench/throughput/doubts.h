// What a reader of figures ought to know before believing them.
#pragma once

#include <string>
#include <vector>

#include "bench/throughput/speed.h"

namespace wavecrest {

constexpr double kWideInterval = 0.05;  // half an interval over its figure: more is no benchmark
constexpr double kWideSpread = 0.1;     // quartiles of slices over their median: of a quiet machine some percent
constexpr double kImpossibleEfficiency = 1.05;  // of threads: together they cannot be that much faster than one alone

// A sentence for each reason; none for figures of a quiet machine that were measured long enough.
std::vector<std::string> doubtsAbout(const Speed& speed);

}  // namespace wavecrest
