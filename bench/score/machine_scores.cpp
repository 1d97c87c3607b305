// Reads and sorts the scores of several machines.
#include "bench/score/machine_scores.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <tuple>

#include "bench/enumerator_name.h"
#include "bench/score/image_verdict.h"

namespace wavecrest {
namespace {

double positive(const nlohmann::json& value) {
  const double number = value.get<double>();
  if (!(number > 0 && std::isfinite(number))) throw ScoreFileError("has a figure that is not a positive number");
  return number;
}

ScoreSize sizeOf(const std::string& name) {
  const auto found = std::ranges::find(kScoreSizeNames, name);
  if (found == kScoreSizeNames.end()) {
    throw ScoreFileError(fmt::format("has size '{}'; expected {}", name, fmt::join(kScoreSizeNames, ", ")));
  }
  return static_cast<ScoreSize>(found - kScoreSizeNames.begin());
}

// What is true of all entries together.
void readEntries(const nlohmann::json& entries, MachineScore& score) {
  for (const nlohmann::json& entry : entries) {
    ++score.entries;
    const auto scene = entry.at("scene").get<std::string>(), method = entry.at("method").get<std::string>();
    const auto image = entry.at("image").get<std::string>();
    score.rates[fmt::format("{}, {}", scene, method)] = positive(entry.at("paths_per_second"));
    const bool tolerated = image == enumeratorName(kValidityNames, Validity::tolerated);
    score.tolerated += tolerated ? 1 : 0;
    if (tolerated || image == enumeratorName(kValidityNames, Validity::exact) || !score.refusal.empty()) continue;
    score.refusal = fmt::format("{} in {}: {}", method, scene, entry.at("image_verdict").get<std::string>());
  }
  score.whole = score.entries == workloadOf(score.size).size();
}

}  // namespace

bool isScore(const nlohmann::json& file) { return file.is_object() && file.value("kind", nlohmann::json()) == "score"; }

MachineScore readMachineScore(const nlohmann::json& file) {
  try {
    if (file.at("score_version") != kScoreVersion) {
      throw ScoreFileError(fmt::format("is of another score version than {}", kScoreVersion));
    }
    MachineScore score;
    score.machine = file.at("machine").at("cpu").get<std::string>();
    score.build = fmt::format("{} {}, {}", file.at("version").get<std::string>(), file.at("commit").get<std::string>(),
                              file.at("compiler").get<std::string>());
    score.isa = file.at("isa").get<std::string>();
    score.threads = file.at("threads").get<uint32_t>();
    score.size = sizeOf(file.at("size").get<std::string>());
    score.score = positive(file.at("score"));
    score.coreScore = positive(file.at("core_score"));
    readEntries(file.at("entries"), score);
    if (!file.at("valid").get<bool>() && score.refusal.empty()) score.refusal = "not valid";
    for (const auto& [method, value] : file.at("method_scores").items()) score.methods[method] = positive(value);
    score.doubts = file.at("doubts").get<std::vector<std::string>>();
    return score;
  } catch (const nlohmann::json::exception&) {
    throw ScoreFileError("is no score of wavecrest bench; expected one written by --score SIZE --json FILE");
  }
}

void sortScores(std::vector<MachineScore>& scores) {
  const auto rank = [](const MachineScore& score) {
    return std::tuple(score.size, !score.refusal.empty(), !score.whole, -score.score);
  };
  std::ranges::stable_sort(scores, [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
}

}  // namespace wavecrest
