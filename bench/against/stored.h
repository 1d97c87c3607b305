// Two stored results of `wavecrest bench --json`, of one machine, compared.
//
// They were not measured in turn, so a verdict may come from the machine: a clock, a neighbour or a temperature that
// changed between the two. What is compared is CPU time per path on one thread: the medians of the visits.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/against/verdict.h"

namespace wavecrest {

// The two cannot be compared. The text is complete but for the files' names.
struct StoredMismatch : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct StoredRow {
  std::string scene, method, size;
  Comparison comparison;  // of the second result over the first
};

struct StoredComparison {
  FamilyLevel family;
  std::vector<StoredRow> rows;         // what both have measured
  std::vector<std::string> unmatched;  // what only one has
  // The smallest that the test can give with so few visits, corrected for the rows. Above the level no row has a
  // verdict.
  double leastProbability = 0;
  bool anySlower() const;
  bool verdictsPossible() const { return leastProbability <= family.level; }
};

// Throws StoredMismatch for files that are not of bench, of other machines, or without anything in common, and where
// two scenes have one name.
StoredComparison compareStored(const nlohmann::json& before, const nlohmann::json& after, const FamilyLevel& family);

std::string toText(const StoredComparison& comparison);
nlohmann::ordered_json toJson(const StoredComparison& comparison);

}  // namespace wavecrest
