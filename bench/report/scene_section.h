// One scene of the report: the images, plots of each metric over time, and its tables.
#pragma once

#include <string>

#include "bench/report/embedded_images.h"
#include "bench/report/report_data.h"

namespace wavecrest {

/// `<section>` for report.scenes[index].
std::string renderScene(const ConvergenceReport& report, size_t index, const EmbeddedImages& images);

/// Scripts beside the page, by their path from it, that hold the floats of its images.
std::vector<std::pair<std::string, std::string>> floatFiles(const ConvergenceReport& report);

}  // namespace wavecrest
