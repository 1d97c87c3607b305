// The plots of one scene, for the page and for plot files alike: every metric over render time, and what is bias in it.
#pragma once

#include <string>
#include <vector>

#include "bench/report/report_data.h"
#include "bench/report/svg_plot.h"

namespace wavecrest {

struct ScenePlot {
  std::string key;  ///< of the metric, or "bias": part of a file name
  std::string heading, explanation;
  Plot plot;
};

std::vector<ScenePlot> scenePlots(const ConvergenceReport& report, const ReportScene& scene);

/// The colour of the series' method and, where several series share it, the dashes that tell them apart.
std::string seriesClass(const ReportScene& scene, const ReportSeries& series);

}  // namespace wavecrest
