#include "cli/findings.h"

#include "bench/claims/judge_claims.h"
#include "cli/commands.h"
#include "cli/messages.h"

namespace wavecrest {

int showFindings(std::span<const ReportClaim> claims, ProgressKind kind) {
  bool held = true;
  size_t judged = 0;
  for (const ReportClaim& claim : claims) {
    printOut("{:24} {}: {} ({})\n", claim.verdict, claim.scene, claim.statement, claim.figure);
    judged += claim.verdict == toString(ClaimVerdict::notJudged) ? 0 : 1;
    if (claim.verdict != toString(ClaimVerdict::fails)) continue;
    tellFailedCheck(kind, fmt::format("{}: {}", claim.scene, claim.statement));
    held = false;
  }
  if (judged < claims.size()) {
    tellMessage(
        kind,
        fmt::format("{} of {} findings were not judged, for the reasons above", claims.size() - judged, claims.size()),
        "");
  }
  if (judged == 0) {
    tellFailedCheck(kind, "nothing was checked, as no finding could be judged");
    held = false;
  }
  return held ? kExitDone : kExitCheck;
}

}  // namespace wavecrest
