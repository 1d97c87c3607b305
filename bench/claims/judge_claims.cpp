#include "bench/claims/judge_claims.h"

#include <fmt/format.h>

#include <algorithm>

#include "bench/claims/claim_needs.h"
#include "bench/claims/judge_conditions.h"

namespace wavecrest {
namespace {

using V = ClaimVerdict;

// All conditions of a claim on one scene. A need that the campaign does not meet overrides their verdict.
Judgement judgeReading(const Claim& claim, const SceneLosses& scene) {
  Judgement all;
  for (const Condition& condition : claim.conditions) all.add(judgeCondition(condition, scene));
  if (const std::string shares = pathShares(claim, scene); !shares.empty()) all.evidence += "; " + shares;
  if (const std::string need = unmetNeed(claim, scene); !need.empty()) {
    all.verdict = V::notJudged;
    all.figure = need;
  }
  return all;
}

bool speaksOfPpm(const Claim& claim) {
  return std::ranges::any_of(claim.conditions, [](const Condition& condition) {
    return std::ranges::count(condition.methods, "ppm") + std::ranges::count(condition.than, "ppm") > 0;
  });
}

// The study does not say where ppm has its direct light from. If both readings were measured, a finding holds or fails
// if it does so by both. If they differ it is not judged if one of them is not, not reached in this time if it holds by
// neither and lacks no more than time by one, else undecided.
Judgement judgeOnScene(const Claim& claim, const std::string& name, const CampaignResults& results) {
  const SceneLosses first(name, results), second(name, results, PpmReading::nextEvent);
  if (!speaksOfPpm(claim) || !second.missing("ppm").empty()) return judgeReading(claim, first);
  if (!first.missing("ppm").empty()) return judgeReading(claim, second);
  Judgement one = judgeReading(claim, first);
  const Judgement other = judgeReading(claim, second);
  if (other.verdict == one.verdict) return one;
  const auto either = [&](V verdict) { return one.verdict == verdict || other.verdict == verdict; };
  return {.verdict = either(V::notJudged)                         ? V::notJudged
                     : either(V::notReached) && !either(V::holds) ? V::notReached
                                                                  : V::undecided,
          .figure = fmt::format("by {}: {}, {}; by {}: {}, {}", first.rowOf("ppm"), toString(one.verdict), one.figure,
                                second.rowOf("ppm"), toString(other.verdict), other.figure),
          .evidence = one.evidence + "; " + other.evidence};
}

// A claim about many scenes: how many of them it holds in.
Judgement judgeOverScenes(const Claim& claim, const CampaignResults& results) {
  Judgement all;
  // Judge the claim on each of its scenes and count the verdicts.
  size_t holding = 0, failing = 0, open = 0, unjudged = 0;
  for (const std::string& name : claim.scenes) {
    Judgement own{.verdict = V::notJudged, .figure = "not in this campaign", .evidence = {}};
    if (results.findScene(name) != nullptr) own = judgeOnScene(claim, name, results);
    holding += own.verdict == V::holds ? 1 : 0;
    failing += own.verdict == V::fails ? 1 : 0;
    open += own.verdict == V::undecided || own.verdict == V::notReached ? 1 : 0;
    unjudged += own.verdict == V::notJudged ? 1 : 0;
    all.evidence +=
        fmt::format("{}{}: {} ({})", all.evidence.empty() ? "" : "; ", name, toString(own.verdict), own.figure);
  }
  all.figure =
      fmt::format("in {} of {} scenes, not in {}; needs {}", holding, claim.scenes.size(), failing, claim.atLeast);
  // The claim fails if even all open and unjudged scenes would be too few. It is not judged if the open ones alone
  // would be too few, but the unjudged ones could make up the number.
  if (holding >= claim.atLeast) {
    all.verdict = V::holds;
  } else if (holding + open + unjudged < claim.atLeast) {
    all.verdict = V::fails;
  } else if (holding + open < claim.atLeast) {
    all.verdict = V::notJudged;
    all.figure = fmt::format("{} of {} scenes cannot be judged, and {} have to hold", unjudged, claim.scenes.size(),
                             claim.atLeast);
  } else {
    all.verdict = V::undecided;
  }
  return all;
}

}  // namespace

std::string_view toString(ClaimVerdict verdict) {
  switch (verdict) {
    case V::holds:
      return "holds";
    case V::fails:
      return "does not hold";
    case V::notReached:
      return "not reached in this time";
    case V::undecided:
      return "undecided";
    case V::notJudged:
      break;
  }
  return "not judged";
}

ClaimRecord judgeClaim(const Claim& claim, const CampaignResults& results) {
  const Judgement all = claim.isGeneral() ? judgeOverScenes(claim, results) : judgeOnScene(claim, claim.scene, results);
  return {.id = claim.id,
          .scene = claim.scene,
          .statement = claim.statement,
          .verdict = std::string(toString(all.verdict)),
          .figure = all.figure,
          .evidence = all.evidence};
}

std::vector<ClaimRecord> judgeStudyClaims(const CampaignResults& results) {
  std::vector<ClaimRecord> records;
  // This key tells that iterations were counted. Claims are about equal time.
  if (results.campaign.contains("spp")) return records;
  for (const Claim& claim : studyClaims()) {
    const auto present = [&](const std::string& scene) { return results.findScene(scene) != nullptr; };
    // A claim is judged if the campaign has its scene, or one of its scenes.
    const bool concerned =
        claim.isGeneral() ? std::any_of(claim.scenes.begin(), claim.scenes.end(), present) : present(claim.scene);
    if (concerned) records.push_back(judgeClaim(claim, results));
  }
  return records;
}

}  // namespace wavecrest
