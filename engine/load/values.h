// Numbers in attributes: "1.5", "1, 2, 3", "true", "#c0ffee".
//
// In: the text and where it stands. Out: finite numbers, or a LoadError that quotes the text.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/load/load.h"

namespace wavecrest {

double parseReal(std::string_view text, const SourceLocation& where);
int64_t parseInteger(std::string_view text, const SourceLocation& where);
bool parseBoolean(std::string_view text, const SourceLocation& where);
// Numbers separated by commas or white space.
std::vector<double> parseReals(std::string_view text, const SourceLocation& where);
Double3 parseTriple(std::string_view text, const SourceLocation& where);

// The tokens of a list separated by any of `separators`.
std::vector<std::string_view> splitTokens(std::string_view text, std::string_view separators = ", \t\r\n");

std::string toLower(std::string_view text);
std::string inQuotes(std::string_view text);  // shortened if long, unprintable bytes replaced

}  // namespace wavecrest
