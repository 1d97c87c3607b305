#include "bench/against/stored.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "bench/text_lines.h"

namespace wavecrest {
namespace {

using Json = nlohmann::json;

constexpr const char* kNoResult = "is not a result of wavecrest bench; expected one written by --json";

// What one result has of a scene, method and size.
struct Measured {
  std::string sceneHash;
  std::vector<double> visits;  // CPU seconds per path on one thread, the median of each visit
};

// By "scene method WxH".
using Series = std::map<std::string, Measured>;

// CPU seconds per path of a method on one thread, the median of each visit; empty if one thread was not measured. The
// slices of one visit are not independent: a machine whose speed drifts moves them together.
std::vector<double> visitsOfOneThread(const Json& method) {
  std::map<size_t, std::vector<double>> visits;
  for (const Json& row : method.at("scaling")) {
    if (row.at("threads") != 1) continue;
    for (const Json& slice : row.at("slices")) {
      const double seconds = slice.at("cpu_seconds").get<double>(), paths = slice.at("paths").get<double>();
      const double perPath = seconds / paths;
      if (!(perPath > 0 && std::isfinite(perPath))) throw StoredMismatch(kNoResult);
      visits[slice.at("visit").get<size_t>()].push_back(perPath);
    }
  }
  std::vector<double> medians;
  medians.reserve(visits.size());
  for (const auto& [visit, values] : visits) medians.push_back(median(values));
  return medians;
}

// The series of all scenes and methods. Throws StoredMismatch where the file is not of bench, or has two scenes of one
// name.
Series seriesOf(const Json& result) {
  Series series;
  try {
    for (const Json& scene : result.at("scenes")) {
      for (const Json& method : scene.at("methods")) {
        const std::string name =
            fmt::format("{} {} {}x{}", scene.at("scene").get<std::string>(), method.at("method").get<std::string>(),
                        scene.at("width").get<int>(), scene.at("height").get<int>());
        Measured own{.sceneHash = scene.value("scene_hash", ""), .visits = visitsOfOneThread(method)};
        // Without visits on one thread there is nothing to compare.
        if (own.visits.empty()) continue;
        if (!series.emplace(name, std::move(own)).second) {
          throw StoredMismatch(fmt::format("have {} twice; expected scenes of different names", name));
        }
      }
    }
  } catch (const Json::exception&) {
    throw StoredMismatch(kNoResult);
  }
  return series;
}

// Processor and number of cores. Only times of equal machines are compared.
std::string machineOf(const Json& result) {
  if (!result.contains("machine")) throw StoredMismatch("does not say which machine it comes from");
  try {
    const Json& machine = result.at("machine");
    return fmt::format("{}, {} cores", machine.value("cpu", "?"), machine.value("cores", 0));
  } catch (const Json::exception&) {
    throw StoredMismatch(kNoResult);
  }
}

// The smallest p-value of the two-sided rank-sum test on so many values: where all values of one side are above all
// of the other.
double leastProbability(size_t a, size_t b) {
  double choices = 1;  // of the ranks of one side
  for (size_t i = 1; i <= a; ++i) choices *= static_cast<double>(b + i) / static_cast<double>(i);
  return std::min(1.0, 2 / choices);
}

}  // namespace

bool StoredComparison::anySlower() const {
  return std::any_of(rows.begin(), rows.end(),
                     [](const StoredRow& row) { return row.comparison.verdict == SpeedVerdict::slower; });
}

StoredComparison compareStored(const Json& before, const Json& after, const FamilyLevel& family) {
  // Read both results, which must be of one machine.
  const Series old = seriesOf(before), now = seriesOf(after);
  if (const std::string a = machineOf(before), b = machineOf(after); a != b) {
    throw StoredMismatch(fmt::format("come from different machines: {}; {}", a, b));
  }
  // Compare the series that both have.
  StoredComparison result{.family = family, .rows = {}, .unmatched = {}};
  double least = 1;
  for (const auto& [name, earlier] : old) {
    const auto found = now.find(name);
    if (found == now.end()) {
      result.unmatched.push_back(name);
      continue;
    }
    const Measured& later = found->second;
    if (later.sceneHash != earlier.sceneHash) {
      throw StoredMismatch(fmt::format("have another scene by the same name: {}", name));
    }
    StoredRow& row = result.rows.emplace_back();
    // The name is "scene method WxH". Only the scene's own may have blanks.
    const size_t second = name.rfind(' '), first = name.rfind(' ', second - 1);
    row.scene = name.substr(0, first);
    row.method = name.substr(first + 1, second - first - 1);
    row.size = name.substr(second + 1);
    // The later result is in the place of "ours": a speedup above 1 means that it is faster.
    row.comparison = compareUnpaired(later.visits, earlier.visits, family);
    least = std::min(least, leastProbability(later.visits.size(), earlier.visits.size()));
  }
  // Name the series that only the later result has.
  for (const auto& [name, later] : now) {
    if (old.count(name) == 0) result.unmatched.push_back(name);
  }
  if (result.rows.empty()) throw StoredMismatch("have no scene, method and size in common");
  // Verdicts, corrected for all rows together.
  std::vector<Comparison*> comparisons;
  for (StoredRow& row : result.rows) comparisons.push_back(&row.comparison);
  judge(comparisons, family);
  result.leastProbability = std::min(1.0, least * static_cast<double>(result.rows.size()));
  return result;
}

std::string toText(const StoredComparison& result) {
  TextLines text;
  line(text, "{:<24} {:<6} {:<10} {:>7} {:>17} {:>9}  {}", "scene", "method", "size", "speed", "interval", "p",
       "verdict");
  for (const StoredRow& row : result.rows) {
    const Comparison& c = row.comparison;
    line(text, "{:<24} {:<6} {:<10} {:>7.4f} {:>8.4f}-{:<8.4f} {:>9.2g}  {}", row.scene, row.method, row.size,
         c.speedup, c.interval.low, c.interval.high, c.probability, toString(c.verdict));
  }
  for (const std::string& name : result.unmatched) line(text, "only in one of them: {}", name);
  line(text,
       "\nspeed: of the second over the first, CPU time per path on one thread; p: rank-sum test of visits, corrected");
  line(text, "for {} comparisons. They were not measured in turn: --against tells a build from a machine that changed.",
       result.rows.size());
  if (!result.verdictsPossible()) {
    line(text, "No verdict is possible: ranks of so few visits have a p of {:.2g} or more here, and the level is {:g};",
         result.leastProbability, result.family.level);
    line(text, "choose fewer scenes and methods, or a higher --family-level.");
  }
  return fmt::to_string(text);
}

nlohmann::ordered_json toJson(const StoredComparison& result) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const StoredRow& row : result.rows) {
    const Comparison& c = row.comparison;
    rows.push_back({{"scene", row.scene},
                    {"method", row.method},
                    {"size", row.size},
                    {"speedup", c.speedup},
                    {"interval", {c.interval.low, c.interval.high}},
                    {"probability", c.probability},
                    {"verdict", std::string(toString(c.verdict))}});
  }
  return {{"family_level", result.family.level},
          {"tolerance", result.family.tolerance},
          {"interval_level", kIntervalLevel},
          {"least_probability", result.leastProbability},
          {"comparisons", rows},
          {"unmatched", result.unmatched}};
}

}  // namespace wavecrest
