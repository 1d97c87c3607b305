// Which method brings a scene to a quality soonest, and how long that takes on this machine.
//
// Makes short test renders, called pilots (pilot_renders.h): one by the reference method of `inspect`, one by every
// method, and of several methods a longer one by that predicted to be first. A pilot is four whole images of different
// seeds. Its noise, bias and speed predict the time (prediction.h). What the pilots cannot tell is said in place of a
// verdict.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "bench/recommend/pilot_renders.h"

namespace wavecrest {

struct RecommendRequest {
  double targetSsim = 0.95;
  double seconds = 60;  // render time of all pilots together; more where whole images take more (kMostOverrun)
  std::vector<Method> methods;
  ClockKind clock = ClockKind::wall;
};

struct RecommendRow {
  Method method{};
  std::string refusal{};  // why the method cannot render the scene; then there is no prediction
  std::string
      leavesOut{};    // classes of paths that the method does not sample: it may not get to the target in any time
  bool told = false;  // whether there were whole images, and so a prediction
  double pilotSeconds = 0;
  double needed = 0;  // seconds of four whole images, at least
  Prediction prediction{};
};

struct Recommendation {
  std::string scene;
  double targetSsim = 0;
  double budget = 0;  // seconds
  Method referenceMethod{};
  double referenceSsim = 0;          // of the reference's mean against itself with its noise; 0 if there is none
  std::vector<RecommendRow> rows{};  // soonest first; then those that do not get there, best first, and those not told
  std::vector<std::string> doubts{};
  std::string untold{};        // why there is no verdict; empty: there is one
  double suggestedBudget = 0;  // seconds, where there is none
  // The best one, if any gets there and the pilots can tell.
  const RecommendRow* best() const;
};

Recommendation recommend(const Scene& scene, const RenderSettings& settings, const RecommendRequest& request);

// Doubts, one paragraph and a table.
std::string toText(const Recommendation& recommendation);
nlohmann::ordered_json toJson(const Recommendation& recommendation);

// From the rows: doubts, whether there is a verdict, and which budget would do.
void judgeRows(Recommendation& recommendation);

}  // namespace wavecrest
