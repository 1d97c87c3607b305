// The pages of renders and campaigns under way: HTML with style sheet and script inside.
#pragma once

#include <string>

namespace wavecrest {

std::string renderViewPage();
std::string campaignViewPage();

}  // namespace wavecrest
