#include "bench/claims/claim_list.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "bench/claims/claims_json.h"

namespace wavecrest {
namespace {

using nlohmann::json;

// The words of claims.json for the kinds of conditions.
constexpr std::array<std::pair<std::string_view, ConditionKind>, 12> kKinds{{{"better", ConditionKind::better},
                                                                             {"faster", ConditionKind::faster},
                                                                             {"good", ConditionKind::good},
                                                                             {"poor", ConditionKind::poor},
                                                                             {"equal", ConditionKind::equal},
                                                                             {"leads", ConditionKind::leads},
                                                                             {"behind", ConditionKind::behind},
                                                                             {"worse_here", ConditionKind::worseHere},
                                                                             {"reaches", ConditionKind::reaches},
                                                                             {"misses", ConditionKind::misses},
                                                                             {"stalls", ConditionKind::stalls},
                                                                             {"biased", ConditionKind::biased}}};

// The kind of a condition. `id` names the claim in the texts of errors.
ConditionKind parseKind(const std::string& id, const std::string& word) {
  const auto found = std::find_if(kKinds.begin(), kKinds.end(), [&](const auto& kind) { return kind.first == word; });
  if (found == kKinds.end()) throw ClaimListError("claim " + id + ": unknown kind '" + word + "'");
  return found->second;
}

// Throws for a key that is not known, so that a misspelt one is not passed over.
void requireKeys(const std::string& id, const json& object, const std::set<std::string>& known) {
  for (const auto& [key, value] : object.items()) {
    if (!known.contains(key)) throw ClaimListError(fmt::format("claim {}: unknown key '{}'", id, key));
  }
}

// One condition. Keys that its kind does not use may be absent.
Condition parseCondition(const std::string& id, const json& object) {
  requireKeys(id, object, {"kind", "metrics", "methods", "than", "factor", "score", "slope", "share", "control"});
  Condition condition;
  condition.kind = parseKind(id, object.at("kind").get<std::string>());
  object.at("metrics").get_to(condition.metrics);
  object.at("methods").get_to(condition.methods);
  if (object.contains("than")) object.at("than").get_to(condition.than);
  condition.factor = object.value("factor", condition.factor);
  condition.score = object.value("score", condition.score);
  condition.slope = object.value("slope", condition.slope);
  condition.share = object.value("share", condition.share);
  condition.control = object.value("control", "");
  return condition;
}

// What a campaign must have. An absent key needs nothing.
ClaimNeeds parseNeeds(const std::string& id, const json& object) {
  requireKeys(id, object, {"light_paths", "paths"});
  return {.lightPaths = object.value("light_paths", 0.0), .paths = object.value("paths", 0.0)};
}

}  // namespace

std::vector<Claim> parseClaims(std::string_view text) {
  std::vector<Claim> claims;
  std::set<std::string> ids;
  try {
    for (const json& object : json::parse(text)) {
      // The claim itself. at() throws where a key that every claim has is absent.
      Claim claim{.id = object.at("id"),
                  .scene = object.at("scene"),
                  .statement = object.at("statement"),
                  .source = object.value("source", "")};
      requireKeys(claim.id, object, {"id", "scene", "statement", "source", "all", "needs", "scenes", "at_least"});
      if (!ids.insert(claim.id).second) throw ClaimListError("claim " + claim.id + ": a second one of this id");
      // Its conditions and needs, and the scenes of a general claim.
      for (const json& condition : object.at("all")) claim.conditions.push_back(parseCondition(claim.id, condition));
      if (object.contains("needs")) claim.needs = parseNeeds(claim.id, object.at("needs"));
      if (object.contains("scenes")) {
        object.at("scenes").get_to(claim.scenes);
        object.at("at_least").get_to(claim.atLeast);
      }
      if (claim.conditions.empty()) throw ClaimListError("claim " + claim.id + ": has no condition");
      claims.push_back(std::move(claim));
    }
  } catch (const json::exception& error) {
    // Errors of syntax, of types and of absent keys.
    throw ClaimListError(std::string("list of claims: ") + error.what());
  }
  return claims;
}

const std::vector<Claim>& studyClaims() {
  // Parsed at the first call.
  static const std::vector<Claim> claims = parseClaims(kClaimsJson);
  return claims;
}

const Claim* findStudyClaim(std::string_view id) {
  const std::vector<Claim>& claims = studyClaims();
  const auto found = std::find_if(claims.begin(), claims.end(), [&](const Claim& claim) { return claim.id == id; });
  return found == claims.end() ? nullptr : &*found;
}

}  // namespace wavecrest
