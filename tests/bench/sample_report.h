// A made-up convergence report, with curves of the kinds that real ones have: falling as 1/sqrt(t), stalling, seeds
// that scatter, a point that no logarithmic axis can show. For the tests of the page.
#pragma once

#include <cstdint>
#include <string>

#include "bench/report/report_data.h"

namespace wavecrest {

/// Two scenes; the first has all of `pt`, `bpt` and `vcm` with two seeds each, the second only `pt`.
ConvergenceReport sampleReport();

/// Independent bytes: what compresses worst.
ReportImage noiseImage(const std::string& label, uint32_t width, uint32_t height, uint32_t seed);

}  // namespace wavecrest
