// The images at the end of each series of a scene, as a report shows them: 8-bit sRGB beside the reference, and the
// FLIP error map of each, all maps of a scene on one scale so that they can be compared.
#pragma once

#include <filesystem>
#include <vector>

#include "bench/report/report_data.h"
#include "metrics/prepared_reference.h"

namespace wavecrest {

/// Fills scene.reference, errorMapScale and the finalImage and errorMap of each series from its file; an empty path
/// leaves a series without. Throws ImageError if an image cannot be read or has another size.
void addFinalImages(ReportScene& scene, const PreparedReference& reference,
                    const std::vector<std::filesystem::path>& files);

}  // namespace wavecrest
