// Tables of how many times better or faster methods are than a baseline: methods by scenes, with the geometric mean.
// The sections on speed-up and on equal samples share them.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/report/report_data.h"

namespace wavecrest {

/// A ratio, positive, and what is known of it where curves end or begin too early.
struct Factor {
  double factor = 0;
  int bound = 0;  ///< 1: at least that; -1: at most that; 0: neither
};

/// The geometric mean of those that are there, and how many they are. Of bounds it is a bound; of bounds of both kinds
/// there is none.
struct FactorMean {
  std::optional<Factor> mean;
  size_t counted = 0;
};
FactorMean geometricMean(std::span<const std::optional<Factor>> factors);

/// "4.2 ×", "≥ 4.2 ×", or a dash.
std::string formatFactor(const std::optional<Factor>& factor);

/// What a method is to a baseline in one scene: a factor for each label of the table.
struct FactorCell {
  std::vector<std::optional<Factor>> factors;
  std::string hint = {};  ///< shown when pointed at
};

struct FactorTable {
  std::string group;  ///< its tables fold, and one of them is open at a time; also their class
  /// Of the factors in a cell. The first one tints the cell and orders the rows.
  std::vector<std::string> labels;
  /// A cell without factors shows dashes.
  std::function<FactorCell(const ReportSeries& method, const ReportSeries& baseline)> compare;
};

/// A table for each baseline, of which the report's own is open (the first method where it names none); empty where
/// there is nothing to compare.
std::string renderFactorTables(const ConvergenceReport& report, const FactorTable& table);

}  // namespace wavecrest
