#include "cli/compare_results.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>

#include "cli/messages.h"
#include "metrics/false_colour.h"

namespace wavecrest {
std::vector<std::string> uniqueLabels(const std::vector<std::string>& files) {
  std::map<std::string, size_t> uses;
  std::vector<std::string> labels;
  for (const std::string& file : files) {
    const std::string stem = std::filesystem::path(file).stem().string();
    std::string label = stem;
    while (label == "reference" || std::find(labels.begin(), labels.end(), label) != labels.end()) {
      label = fmt::format("{}.{}", stem, ++uses[stem] + 1);
    }
    labels.push_back(std::move(label));
  }
  return labels;
}

nlohmann::ordered_json toJson(const std::vector<MeasuredTest>& tests) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const MeasuredTest& test : tests) {
    nlohmann::ordered_json& json = all.emplace_back(nlohmann::ordered_json::object());
    if (tests.size() > 1) json["test"] = test.file;
    json.update(comparisonJson(test.scores, test.nonFinitePixels));
  }
  return tests.size() == 1 ? all.front() : all;
}

void printText(const std::vector<MeasuredTest>& tests) {
  for (const MeasuredTest& test : tests) {
    if (tests.size() > 1) printOut("{}\n", test.file);
    for (const Measured& measured : test.scores) {
      std::string line;
      for (const Score& score : measured.measurement.scores) {
        line += fmt::format("{}{}{}{:.9g}", line.empty() ? "" : "  ", score.name, score.name.empty() ? "" : " ",
                            score.value);
      }
      if (!measured.metric->conditions.empty()) line += fmt::format("  ({})", measured.metric->conditions);
      printOut("{:8} {}\n", measured.metric->name, line);
    }
    if (test.nonFinitePixels > 0) printOut("{} pixels are not finite and were excluded\n", test.nonFinitePixels);
  }
}

double rangeOfMap(const Measured& score) {
  return score.metric->mapRange != 0 ? score.metric->mapRange : quantile(score.measurement.map, 0.999);
}

ShownMap showMap(const Measured& score, uint32_t width, uint32_t height) {
  const double range = rangeOfMap(score);
  return {falseColour(score.measurement.map, width, height, range), range};
}

std::filesystem::path mapFile(const std::filesystem::path& folder, const std::string& label, bool single,
                              const Metric& metric) {
  const std::string name = std::string(metric.name) + ".png";
  return single ? folder / name : folder / label / name;
}

}  // namespace wavecrest
