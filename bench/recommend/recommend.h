// Which method brings a scene to a quality soonest, and how long that takes on this machine.
//
// Makes short test renders, called pilots: one by the reference method of `inspect`, one by every method, and a longer
// one by the method predicted to be first. A pilot is four renders of different seeds. Its noise, bias and speed
// predict the time (prediction.h).
#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "bench/recommend/prediction.h"
#include "engine/session/session.h"

namespace wavecrest {

// What a second is: of the wall clock while rendering, or of CPU time over the number of threads, which leaves out what
// other programs take on a busy machine.
enum class PilotClock { wall, cpu };
constexpr std::array<std::string_view, 2> kPilotClockNames{"wall", "cpu"};

struct RecommendRequest {
  double targetSsim = 0.95;
  double seconds = 60;  // render time of all pilots together
  std::vector<Method> methods;
  PilotClock clock = PilotClock::wall;
};

struct RecommendRow {
  Method method{};
  std::string refusal;  // why the method cannot render the scene; then there is no prediction
  double pilotSeconds = 0;
  Prediction prediction;
};

struct Recommendation {
  std::string scene;
  double targetSsim = 0;
  Method referenceMethod{};
  double referenceSsim = 0;        // of the reference's halves' mean against itself with its noise: what can be judged
  std::vector<RecommendRow> rows;  // soonest first; then those that do not get there, best first
  // The best one, if any gets there.
  const RecommendRow* best() const;
};

Recommendation recommend(const Scene& scene, const RenderSettings& settings, const RecommendRequest& request);

// One paragraph and a table.
std::string toText(const Recommendation& recommendation);
nlohmann::ordered_json toJson(const Recommendation& recommendation);

}  // namespace wavecrest
