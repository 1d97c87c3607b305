// How a method looks in every plot and table: its name in words, and the mark of its curve. Colours are in
// assets/report.css under the same identifier, so that they follow light and dark.
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace wavecrest {

/// Shapes tell curves apart where colour cannot: in print and for colour-blind readers.
enum class CurveMark { kCircle, kSquare, kTriangleUp, kDiamond, kTriangleDown, kPlus, kCross };

struct MethodStyle {
  std::string_view id, name;
  CurveMark mark;
};

inline constexpr std::array<MethodStyle, 20> kMethodStyles = {{
    {"pt", "path tracing", CurveMark::kCircle},
    {"pt-auto", "path tracing, default settings", CurveMark::kCircle},
    {"lt", "light tracing", CurveMark::kSquare},
    {"lt-auto", "light tracing, default settings", CurveMark::kSquare},
    {"bpt", "bidirectional path tracing", CurveMark::kTriangleUp},
    {"bpt-auto", "bidirectional path tracing, default settings", CurveMark::kTriangleUp},
    {"mlt-pathspace", "Metropolis light transport in path space", CurveMark::kDiamond},
    {"mlt", "Metropolis light transport, multiplexed", CurveMark::kDiamond},
    {"mlt-pssmlt", "Metropolis light transport in primary sample space", CurveMark::kDiamond},
    {"ppm", "progressive photon mapping", CurveMark::kTriangleDown},
    {"ppm-auto", "progressive photon mapping, default settings", CurveMark::kTriangleDown},
    {"ppm-direct", "progressive photon mapping, direct light by next event estimation", CurveMark::kTriangleDown},
    {"bpm", "bidirectional photon mapping", CurveMark::kPlus},
    {"bpm-auto", "bidirectional photon mapping, default settings", CurveMark::kPlus},
    {"vcm", "vertex connection and merging", CurveMark::kCross},
    {"vcm-auto", "vertex connection and merging, default settings", CurveMark::kCross},
    {"gpt", "guided path tracing", CurveMark::kCircle},
    {"gpt-auto", "guided path tracing, default settings", CurveMark::kCircle},
    {"evcm", "efficiency-aware vertex connection and merging", CurveMark::kCross},
    {"evcm-auto", "efficiency-aware vertex connection and merging, default settings", CurveMark::kCross},
}};

/// The style of a method; one that is not listed gets a plain one under its own name.
constexpr MethodStyle methodStyle(std::string_view id) {
  for (const MethodStyle& style : kMethodStyles) {
    if (style.id == id) return style;
  }
  return {id, id, CurveMark::kCircle};
}

/// The identifier of a method by any name: letters, digits, - and _ as they are, anything else as -. It is a class of
/// style sheets.
inline std::string methodId(std::string name) {
  for (char& letter : name) {
    const bool kept = (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') ||
                      (letter >= '0' && letter <= '9') || letter == '_';
    if (!kept) letter = '-';
  }
  return name;
}

/// Where a method stands in the list: the order of tables and pictures. Methods that are not listed come last.
constexpr size_t methodRank(std::string_view id) {
  size_t rank = 0;
  while (rank < kMethodStyles.size() && kMethodStyles[rank].id != id) ++rank;
  return rank;
}

}  // namespace wavecrest
