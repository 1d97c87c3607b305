// `wavecrest report`: a results folder in, DIR/report.html out.
#pragma once

#include <filesystem>

namespace wavecrest {

/// Collects, renders and writes folder/report.html (replaced as a whole or not at all); returns its path. Throws what
/// collectReport throws.
std::filesystem::path writeReport(const std::filesystem::path& folder);

}  // namespace wavecrest
