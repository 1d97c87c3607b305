#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/extremes/extremes_report.h"

namespace wavecrest {

nlohmann::ordered_json toJson(const SweepResult& result) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const SweepRow& row : result.rows) {
    rows.push_back({{"value", row.value},
                    {"method", std::string(toString(row.method))},
                    {"precision", std::string(kPrecisionNames[static_cast<size_t>(row.precision)])},
                    {"error", row.error},
                    {"standard_error", row.standardError},
                    {"nonfinite_samples", row.losses.nonFinite},
                    {"close_pairs", row.losses.closePairs},
                    {"paths_cut", row.losses.cutPaths},
                    {"failure", row.failure}});
  }
  const Sweep& sweep = *result.sweep;
  return {{"name", sweep.name},
          {"title", sweep.title},
          {"value", sweep.xLabel},
          {"bound", sweep.bound},
          {"bound_from", sweep.boundSource},
          {"left_out", sweep.leftOut},
          {"passes", result.passes()},
          {"rows", rows}};
}

std::string toText(const SweepResult& result) {
  const auto failed = static_cast<size_t>(
      std::count_if(result.rows.begin(), result.rows.end(), [](const SweepRow& row) { return !row.failure.empty(); }));
  std::string text = fmt::format("{:24} {:3} rows, {} failed\n", result.sweep->name, result.rows.size(), failed);
  for (const SweepRow& row : result.rows) {
    if (row.failure.empty()) continue;
    text += fmt::format("  {} {} at {:g}: {}\n", toString(row.method),
                        kPrecisionNames[static_cast<size_t>(row.precision)], row.value, row.failure);
  }
  return text;
}

}  // namespace wavecrest
