#include "cli/findings.h"

#include <fmt/core.h>

#include "bench/claims/judge_claims.h"
#include "cli/commands.h"
#include "cli/messages.h"

namespace wavecrest {

int showFindings(std::span<const ReportClaim> claims) {
  bool held = true;
  for (const ReportClaim& claim : claims) {
    fmt::print("{:13} {}: {} ({})\n", claim.verdict, claim.scene, claim.statement, claim.evidence);
    if (claim.verdict != toString(ClaimVerdict::fails)) continue;
    tell("wavecrest: check failed: {}: {}", claim.scene, claim.statement);
    held = false;
  }
  return held ? kExitDone : kExitCheck;
}

}  // namespace wavecrest
