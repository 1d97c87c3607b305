// What a report opens with: which method to take for which scene, in a few sentences.
#pragma once

#include <string>
#include <vector>

#include "bench/report/report_data.h"

namespace wavecrest {

/// A paragraph for each metric with a target: methods with the scenes where they reach it first, and what came closest
/// where none did. Empty text where there is no such metric, or a single method.
std::string renderAnswer(const ConvergenceReport& report);

/// For one scene and metric, in plain text: "bpt, 2.1 s", "bpt or vcm, 2.1 s", or "none; vcm came closest, 0.93".
/// Methods that seeds cannot tell from the fastest are named with it.
struct SceneAnswer {
  std::vector<std::string> methods;  // the fastest one, then those level with it
  std::string figure;                // its time, or the score of what came closest and what its reference allows
  bool reached = false;
};
SceneAnswer answerFor(const ReportScene& scene, const ReportMetric& metric, size_t metricIndex);

}  // namespace wavecrest
