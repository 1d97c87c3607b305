// The images of each series of a scene, as a report shows them: 8-bit sRGB beside the reference, at the end and at a
// sixteenth and a quarter of the longest run; and the FLIP error map of each at the end, all maps of a scene on one
// scale so that they can be compared.
#pragma once

#include <filesystem>
#include <vector>

#include "bench/report/report_data.h"
#include "metrics/prepared_reference.h"

namespace wavecrest {

struct TimedImage {
  double seconds = 0;  ///< render clock
  std::filesystem::path file;
};

/// Fills what scene and series have of images. files: for each series those of one run, in order of time; a series
/// without any stays without. Throws ImageError if an image cannot be read or has another size.
void addImages(ReportScene& scene, const PreparedReference& reference,
               const std::vector<std::vector<TimedImage>>& files);

}  // namespace wavecrest
