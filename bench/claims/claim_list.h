// The study's findings as data: bench/claims/claims.json, which is built into the program.
//
// A claim holds where all its conditions hold. A condition speaks of losses at the end of runs of equal time: the
// metric itself where less is better, else its distance from the best possible score (1 - SSIM, 100 - Q_MOS).
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace wavecrest {

enum class ConditionKind {
  better,   // each of `methods` has a smaller loss than each of `than`
  good,     // each of `methods` is within `factor` of each of `than`
  poor,     // each of `methods` is beyond `factor` of some of `than`
  equal,    // any two of `methods` are within `factor` of each other
  reaches,  // the score of each of `methods` is at least `score`
  misses,   // the score of each of `methods` is below `score`
  stalls,   // from a quarter of the time on the loss goes as time to a power of at least `slope`
  biased    // squared bias is at least `share` of the mean square error
};

struct Condition {
  ConditionKind kind{};
  std::vector<std::string> metrics, methods, than;
  double factor = 1, score = 0, slope = 0, share = 0;
};

struct Claim {
  std::string id, scene, statement;
  std::string source = {};       // the study's words
  std::string explanation = {};  // why it may not hold here, or stay open; shown where that is so
  std::vector<Condition> conditions = {};
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
