#include "tests/metrics/golden.h"

#include <fstream>
#include <stdexcept>

#include "tests/effort.h"
#include "tests/metrics/golden_json.h"

namespace wavecrest::test {

nlohmann::json goldenJson(const std::string& name) {
  std::ifstream stream(goldenPath(name));
  return nlohmann::json::parse(stream);
}

nlohmann::json goldenFigures(const std::string& file, const std::string& pair) {
  const auto figures = goldenJson(file);
  for (const auto& entry : figures["pairs"])
    if (entry["pair"] == pair) return entry;
  throw std::runtime_error("no golden figures for " + pair);
}

// Two thirds of all pixels. Odd sides and several levels are what the others have too.
constexpr const char* kLargestPair = "p5_room_1024x768";

const std::vector<GoldenPair>& goldenPairs() {
  static const std::vector<GoldenPair> pairs = [] {
    std::vector<GoldenPair> list;
    const auto figures = goldenJson("rmse.json");
    for (const auto& entry : figures["pairs"]) {
      const std::string name = entry["pair"];
      if (!kFullSpeed && name == kLargestPair) continue;
      list.push_back({name, readCodes(goldenPath(name + "_ref.png")), readCodes(goldenPath(name + "_test.png"))});
    }
    return list;
  }();
  return pairs;
}

double goldenFigure(const std::string& file, const std::string& pair, const std::string& figure) {
  return goldenFigures(file, pair).at(figure).get<double>();
}

double goldenFigure(const std::string& file, const std::string& pair, const std::string& figure, size_t index) {
  return goldenFigures(file, pair).at(figure).at(index).get<double>();
}

}  // namespace wavecrest::test
