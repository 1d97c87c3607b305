// This build against another: both render the same work in turn, in processes of their own, and are compared by CPU
// time, which leaves out what other programs take from the cores.
//
// One round renders every scene by every method once with each build, the second round in the opposite order, so a
// machine that changes its speed meets both alike. Each run is of a fresh copy of its program (program_copy.h). Any
// build with `render --stats` can be the other one.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "bench/against/verdict.h"

namespace wavecrest {

struct AgainstRequest {
  std::filesystem::path other;
  std::vector<std::filesystem::path> scenes;
  std::vector<std::string> methods;
  std::string size;  // WIDTHxHEIGHT, or empty for the scenes' own
  uint32_t threads = 1;
  double seconds = 20;  // CPU time of both builds per scene and method, about
  FamilyLevel family;
  std::vector<std::string> more;  // options for both builds' render
};

struct AgainstRow {
  std::string scene, method;
  uint64_t iterations = 0;                       // of each run
  std::vector<double> ourSeconds, otherSeconds;  // CPU time of each run
  bool sameImage = false;                        // bit for bit, after one iteration
  double imageDifference = 0;                    // root mean square over pixels, relative to the other's image
  Comparison comparison;
};

struct AgainstResult {
  std::filesystem::path ours, other;
  std::string ourVersion, otherVersion;  // version and commit, as the builds tell
  // Of the two those that only run where they stand. Where in memory that is makes part of their speed, in all runs
  // alike, which a verdict cannot tell from a difference of the code.
  std::vector<std::filesystem::path> inPlace;
  uint32_t threads = 1;
  FamilyLevel family;
  std::vector<AgainstRow> rows;

  bool anySlower() const;
};

// Rounds of a request for so many seconds, where the longest run takes longestRun: CPU seconds, and at least
// kFewestRounds rounds: their ranks reach a level of 0.05 in a family of up to 102 rows (2 / 2^12 each).
constexpr size_t kFewestRounds = 12;
size_t roundsOf(double seconds, double longestRun);

// progress: called after each round with the number of rounds done and of all.
AgainstResult runAgainst(const AgainstRequest& request, const std::function<void(size_t, size_t)>& progress);

std::string toText(const AgainstResult& result);
nlohmann::ordered_json toJson(const AgainstResult& result);

}  // namespace wavecrest
