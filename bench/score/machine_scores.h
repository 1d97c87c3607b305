// Scores of several machines side by side: what `bench --score --json` has written, as a table and a page.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "bench/score/workload.h"

namespace wavecrest {

struct MachineScore {
  std::string machine;  // its processor, as the system names it
  std::string build;    // version, commit and compiler
  std::string isa;
  uint32_t threads = 1;
  ScoreSize size{};
  double score = 0, coreScore = 0;        // 100: a core of the reference machine
  bool whole = true;                      // measured on the whole workload; else not comparable with others
  std::string refusal;                    // the first image that was not accepted, and why; empty for a valid score
  size_t entries = 0, tolerated = 0;      // images in all, and those that were accepted by tolerance instead of hash
  std::map<std::string, double> methods;  // scores by method
  std::map<std::string, double> rates;    // paths per second of wall time on all threads, by "scene, method"
  std::vector<std::string> doubts;
};

// Whether the JSON is a result of `bench --score`. A folder may hold results of other modes as well.
bool isScore(const nlohmann::json& file);

// Throws ScoreFileError for a score of another version, or without what bench/schema.json requires.
MachineScore readMachineScore(const nlohmann::json& file);

// By size; within one the highest score first, and then those that do not count.
void sortScores(std::vector<MachineScore>& scores);

// scores: sorted. At least one.
std::string machinesText(const std::vector<MachineScore>& scores);
std::string machinesPage(const std::vector<MachineScore>& scores);
nlohmann::ordered_json machinesJson(const std::vector<MachineScore>& scores);

}  // namespace wavecrest
