// The page's style sheet and script. They are ordinary files (assets/*.css, assets/report.js), turned into these
// strings at build time by cmake/embed_text.cmake.
#pragma once

#include <string_view>

namespace wavecrest {

extern const std::string_view kPlotCss;  ///< plots alone: also inside plots that are files of their own
extern const std::string_view kReportCss;
extern const std::string_view kReportJs;
extern const std::string_view kFloatsJs;

}  // namespace wavecrest
