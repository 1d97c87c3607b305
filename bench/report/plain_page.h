// What all pages have in common, and pages of sections without images or scripts.
#pragma once

#include <string>
#include <string_view>

namespace wavecrest {

/// The document up to and with `<body>`; title: plain text.
std::string pageHead(std::string_view title, std::string_view css = {});

/// A whole page: its title as a heading, then the sections, which are HTML.
std::string plainPage(std::string_view title, std::string_view sections);

}  // namespace wavecrest
