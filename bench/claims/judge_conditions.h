// Judges one condition of a claim on one scene, with the one figure that decides it and all values as evidence.
#pragma once

#include <string>

#include "bench/claims/judge_claims.h"
#include "bench/claims/scene_losses.h"

namespace wavecrest {

struct Judgement {
  ClaimVerdict verdict = ClaimVerdict::holds;
  std::string figure = {};    // in some ten words: the comparison that decides
  std::string evidence = {};  // all values, for people

  // Of a claim all conditions must hold: one that fails decides, then one that is not reached in this time, one that
  // cannot be judged, an open one.
  void add(const Judgement& other);
};

Judgement judgeCondition(const Condition& condition, const SceneLosses& scene);

}  // namespace wavecrest
