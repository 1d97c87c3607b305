// The study's findings as data: bench/claims/claims.json, which is built into the program.
//
// A claim holds where all its conditions hold. A condition speaks of losses at the end of runs of equal time, or of the
// time to equal quality. A loss is the metric itself where less is better, else its distance from the best possible
// score (1 - SSIM, 100 - Q_MOS). What a campaign must have for a claim to be judged at all is part of the claim
// (ClaimNeeds).
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace wavecrest {

enum class ConditionKind {
  better,     // each of `methods` has a smaller loss than each of `than`
  faster,     // each of `methods` takes less time than each of `than` to the best quality that both reach
  good,       // each of `methods` is within `factor` of each of `than`
  poor,       // each of `methods` is beyond `factor` of more than half of `than`
  equal,      // any two of `methods` are within `factor` of each other
  leads,      // one of `methods` is within `factor` of each of `than`
  behind,     // each of `methods` has a larger loss than one of `than`
  worseHere,  // loss of each of `methods` over that of each of `than`: beyond `factor` times that in the scene
              // `control`
  reaches,    // the score of each of `methods` is at least `score`
  misses,     // the score of each of `methods` is below `score`
  stalls,     // error of `methods` falls as time to a power of at least `slope`, that of each of `than` does not
  biased      // squared bias is at least `share` of the mean square error
};

struct Condition {
  ConditionKind kind{};
  std::vector<std::string> metrics = {}, methods = {}, than = {};
  double factor = 1, score = 0, slope = 0, share = 0;
  std::string control = {};  // a scene
};

// What a campaign must have for the claim to be judged; 0: nothing. Shares are of what the study had (study.h).
struct ClaimNeeds {
  double lightPaths = 0;  // light paths that a search for photons can meet, of each merging method of the claim
  double paths = 0;       // paths per pixel by the end, of each method of the claim
};

struct Claim {
  std::string id, scene, statement;  // scene: "general" where `scenes` are several
  std::string source = {};           // the study's words
  std::vector<Condition> conditions = {};
  ClaimNeeds needs = {};
  // A claim about many scenes holds where its conditions hold in at least so many of them.
  std::vector<std::string> scenes = {};
  size_t atLeast = 0;

  bool isGeneral() const { return !scenes.empty(); }
};

// A list of claims that is not what it should be. The text is complete.
struct ClaimListError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

std::vector<Claim> parseClaims(std::string_view json);

const std::vector<Claim>& studyClaims();
// Null if there is none of this id.
const Claim* findStudyClaim(std::string_view id);

}  // namespace wavecrest
