#include "bench/claims/explanations.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <set>

#include "bench/claims/claim_list.h"
#include "bench/claims/explanations_json.h"

namespace wavecrest {

std::vector<Explanation> parseExplanations(std::string_view text) {
  using nlohmann::json;
  std::vector<Explanation> explanations;
  try {
    const json profiles = json::parse(text);
    for (const auto& [profile, campaign] : profiles.items()) {
      const std::string commit = campaign.at("commit");
      std::set<std::string> explained;
      for (const json& entry : campaign.at("findings")) {
        Explanation& explanation = explanations.emplace_back();
        explanation.profile = profile;
        explanation.commit = commit;
        entry.at("text").get_to(explanation.text);
        entry.at("verdict").get_to(explanation.verdict);
        entry.at("claims").get_to(explanation.claims);
        if (explanation.claims.empty()) throw ClaimListError("explanations: one of " + profile + " is of no claim");
        for (const std::string& claim : explanation.claims) {
          if (findStudyClaim(claim) == nullptr) throw ClaimListError("explanations: no claim has the id " + claim);
          if (!explained.insert(claim).second) {
            throw ClaimListError("explanations: a second one of " + claim + " in " + profile);
          }
        }
      }
    }
  } catch (const json::exception& error) {
    // Errors of syntax, of types and of absent keys.
    throw ClaimListError(std::string("explanations: ") + error.what());
  }
  return explanations;
}

const std::vector<Explanation>& studyExplanations() {
  // Parsed at the first call.
  static const std::vector<Explanation> explanations = parseExplanations(kExplanationsJson);
  return explanations;
}

bool isOf(const Explanation& explanation, std::string_view profile, std::string_view commit) {
  const std::string all = ", " + std::string(commit) + ", ";
  return explanation.profile == profile && all.find(", " + explanation.commit + ", ") != std::string::npos;
}

const Explanation* findExplanation(std::string_view claim, std::string_view verdict, std::string_view profile) {
  const std::vector<Explanation>& all = studyExplanations();
  for (const std::string_view wanted : std::array<std::string_view, 3>{profile, "study", "standard"}) {
    const auto found = std::ranges::find_if(all, [&](const Explanation& explanation) {
      return explanation.profile == wanted && explanation.verdict == verdict &&
             std::ranges::count(explanation.claims, claim) != 0;
    });
    if (found != all.end()) return &*found;
  }
  return nullptr;
}

}  // namespace wavecrest
