// Results of a campaign that were not rendered, for tests of findings.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "bench/claims/judge_claims.h"
#include "bench/statistics/bands.h"

namespace wavecrest {

// Results of one scene "s"; each method has a run per final score, with an RMSE that falls from twice that value at a
// quarter of the time (a slope of -1/2) unless given otherwise.
class MadeUp {
 public:
  MadeUp() { results_.scenes.push_back({.name = "s", .hash = "0", .referenceFile = ""}); }
  MadeUp& with(const std::string& method, const std::string& metric, const std::vector<double>& finalScores,
               double before = 2) {
    for (size_t i = 0; i < finalScores.size(); ++i) {
      results_.runs.push_back(
          {.scene = "s",
           .method = method,
           .seed = i + 1,
           .snapshots = {
               {.number = 0,
                .renderSeconds = 1,
                .iterations = 1,
                .file = "",
                .values = {{metric, before * finalScores[i]}}},
               {.number = 1, .renderSeconds = 4, .iterations = 4, .file = "", .values = {{metric, finalScores[i]}}}}});
    }
    return *this;
  }
  // A run with these scores after 1, 2, 4, ... seconds.
  MadeUp& curve(const std::string& method, const std::string& metric, const std::vector<double>& scores) {
    RunRecord run{.scene = "s", .method = method, .seed = 1};
    for (unsigned k = 0; k < scores.size(); ++k) {
      run.snapshots.push_back({.number = k,
                               .renderSeconds = std::pow(2.0, k),
                               .iterations = k,
                               .file = "",
                               .values = {{metric, scores[k]}}});
    }
    results_.runs.push_back(run);
    return *this;
  }
  // A run with these errors after 1, 2, 4, ... seconds, measured against a reference with this noise.
  MadeUp& errors(const std::string& method, const std::vector<double>& values, double noise) {
    std::vector<double> measured;
    measured.reserve(values.size());
    for (const double value : values) measured.push_back(std::hypot(value, noise));
    curve(method, "rmse", measured);
    std::vector<SnapshotRecord>& snapshots = results_.runs.back().snapshots;
    for (size_t k = 0; k < values.size(); ++k) snapshots[k].values[kUnbiasedMse] = values[k] * values[k];
    return *this;
  }
  // Multiplies the times of all snapshots of a method by the factor.
  MadeUp& delay(const std::string& method, double factor) {
    for (RunRecord& run : results_.runs) {
      if (run.method != method) continue;
      for (SnapshotRecord& snapshot : run.snapshots) snapshot.renderSeconds *= factor;
    }
    return *this;
  }
  MadeUp& floor(const std::string& metric, double value) {
    results_.scenes[0].noiseFloors[metric] = value;
    return *this;
  }
  MadeUp& refuse(const std::string& method) {
    results_.runs.push_back(
        {.scene = "s", .method = method, .seed = 1, .state = RunState::refused, .reason = "it cannot"});
    return *this;
  }
  MadeUp& bias(const std::string& method, const std::vector<double>& shares, unsigned seeds = kFewestSeedsForShare) {
    for (unsigned i = 0; i < shares.size(); ++i) {
      results_.biases.push_back({"s", method, i, seeds, 1.0, 1 - shares[i], shares[i]});
    }
    return *this;
  }
  // Errors without the reference's noise, whose root goes as time to this power, at five times.
  MadeUp& slope(const std::string& method, const std::vector<double>& powers) {
    for (size_t i = 0; i < powers.size(); ++i) {
      RunRecord run{.scene = "s", .method = method, .seed = i + 1};
      for (unsigned k = 0; k < 5; ++k) {
        const double time = std::pow(2.0, k);
        run.snapshots.push_back({.number = k,
                                 .renderSeconds = time,
                                 .iterations = k,
                                 .file = "",
                                 .values = {{kUnbiasedMse, std::pow(time, 2 * powers[i])}}});
      }
      results_.runs.push_back(run);
    }
    return *this;
  }
  // The stats of every run.
  MadeUp& stats(const std::string& json) {
    for (RunRecord& run : results_.runs) run.stats = json;
    return *this;
  }
  MadeUp& scene(const std::string& name) {
    results_.scenes.push_back({.name = name, .hash = "0", .referenceFile = ""});
    for (RunRecord& run : results_.runs) run.scene = run.scene == "s" ? name : run.scene;
    return *this;
  }
  ClaimRecord judge(const Condition& condition) const {
    return judgeClaim({.id = "c", .scene = "s", .statement = "so", .conditions = {condition}}, results_);
  }
  std::string verdict(const Condition& condition) const { return judge(condition).verdict; }
  const CampaignResults& results() const { return results_; }

 private:
  CampaignResults results_;
};

inline Condition condition(ConditionKind kind, const std::string& metric, const std::vector<std::string>& methods,
                           const std::vector<std::string>& than = {}) {
  return {.kind = kind, .metrics = {metric}, .methods = methods, .than = than};
}

// Stats of a run with a thousandth of the study's paths.
inline const char* const kFewPaths = R"({"width": 10, "height": 10, "camera_paths": 879})";

inline const std::string kHolds = "holds", kFails = "does not hold", kUndecided = "undecided",
                         kNotJudged = "not judged", kNotReached = "not reached in this time";

}  // namespace wavecrest
