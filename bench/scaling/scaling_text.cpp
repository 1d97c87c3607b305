// The table of `bench --scaling` for a terminal.
#include <algorithm>

#include "bench/scaling/scaling.h"
#include "bench/text_lines.h"

namespace wavecrest {

std::string toText(const ScalingResult& result) {
  TextLines text;
  line(text, "{} {} {}x{}", result.scene, toString(result.method), result.width, result.height);
  for (const std::string& doubt : doubtsAbout(result.machine)) line(text, "  doubt: {}", doubt);
  line(text, "  {:>7} {:>12} {:>15} {:>10} {:>15} {:>16} {:>7} {:>13}", "threads", "M paths/s", "speedup", "processes",
       "predicted", "work / span", "tasks", "longest, ms");
  const auto measuredOf = [&](uint32_t count) {
    return std::find_if(result.measured.begin(), result.measured.end(),
                        [count](const MeasuredScaling& row) { return row.threads == count; });
  };
  const auto predictedOf = [&](uint32_t count) {
    return std::find_if(result.predicted.begin(), result.predicted.end(),
                        [count](const PredictedScaling& row) { return row.threads == count; });
  };
  const uint32_t most = std::max(kMostPredictedThreads, result.measured.back().threads);
  for (uint32_t threads = 1; threads <= most; ++threads) {
    const auto measured = measuredOf(threads);
    const auto predicted = predictedOf(threads);
    if (measured == result.measured.end() && predicted == result.predicted.end()) continue;
    std::string left = fmt::format("{:>12} {:>15} {:>10}", "", "", ""), right;
    if (measured != result.measured.end()) {
      left = fmt::format("{:>12.3f} {:>15} {:>10.2f}", 1e-6 * measured->pathsPerSecond.value, times(measured->speedup),
                         measured->processSpeedup);
    }
    if (predicted != result.predicted.end()) {
      right = fmt::format(" {:>15} {:>16} {:>7} {:>13.2f}", times(predicted->speedup), times(predicted->parallelism),
                          predicted->tasks, 1e3 * predicted->longestTask);
    }
    line(text, "  {:>7} {}{}", threads, left, right);
  }
  line(text, "  {:>8} {:>13} {:>10}", "machines", "snapshot, MB", "merge, s");
  for (const PartsScaling& row : result.parts) {
    line(text, "  {:>8} {:>13.1f} {:>10.3f}", row.machines, 1e-6 * static_cast<double>(row.bytes), row.mergeSeconds);
  }
  return fmt::to_string(text);
}

}  // namespace wavecrest
