// Texts of the live pages, embedded by CMake from assets/.
#pragma once

#include <string_view>

namespace wavecrest {

extern const std::string_view kLiveCss, kLiveJs, kRenderViewHtml, kRenderViewJs, kCampaignViewHtml, kCampaignViewJs;

}  // namespace wavecrest
