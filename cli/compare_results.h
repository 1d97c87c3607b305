// What `wavecrest compare` has measured of each test image, and how it is shown: text, JSON, false-colour maps.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "library/comparison.h"

namespace wavecrest {

struct MeasuredTest {
  std::string file;
  std::string label;  // names its maps and its pane; unique among the tests
  Image8 picture;     // by PreparedReference::pictureOf
  ImageFile light;    // as it was read, for --html; else empty
  uint64_t nonFinitePixels = 0;
  std::vector<Measured> scores;
};

// The stem of each file, with a number where several have the same, or where it is "reference", which names the
// reference's pane.
std::vector<std::string> uniqueLabels(const std::vector<std::string>& files);

// Of one test an object; of several an array of objects that begin with "test", the file.
nlohmann::ordered_json toJson(const std::vector<MeasuredTest>& tests);
void printText(const std::vector<MeasuredTest>& tests);

// A metric's map in false colours, and the value that is shown brightest.
struct ShownMap {
  Image8 picture;
  double range = 0;
};
double rangeOfMap(const Measured& score);
ShownMap showMap(const Measured& score, uint32_t width, uint32_t height);

// Of one test FOLDER/METRIC.png, of several FOLDER/LABEL/METRIC.png.
std::filesystem::path mapFile(const std::filesystem::path& folder, const std::string& label, bool single,
                              const Metric& metric);

}  // namespace wavecrest
