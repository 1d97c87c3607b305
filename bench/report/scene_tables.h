// The tables of one scene, as HTML: what each method reached, bias and variance, which paths it can sample, where its
// time went, and with which settings it ran. Each is empty text where there is nothing to say.
#pragma once

#include <string>

#include "bench/report/report_data.h"

namespace wavecrest {

/// Methods in the order of the first metric at the end, with all metrics and the times to the metrics' targets.
std::string renderResults(const ConvergenceReport& report, const ReportScene& scene);

std::string renderBias(const ReportScene& scene);
std::string renderPathClasses(const ReportScene& scene);
std::string renderStages(const ReportScene& scene);
std::string renderSettings(const ReportScene& scene);

}  // namespace wavecrest
