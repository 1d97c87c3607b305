// Judges claims on the results of a campaign: holds, does not hold, or undecided within noise, with the evidence.
//
// Losses are compared by their logarithms at the end of runs of equal render time, with 95 % bands from the seeds. A
// comparison that the bands leave open is undecided, and so is one of losses that are no more than the reference's own
// noise, of methods that were not measured, and of a single seed, which has no band.
#pragma once

#include <span>
#include <vector>

#include "bench/claims/claim_list.h"
#include "bench/results/results.h"

namespace wavecrest {

enum class ClaimVerdict { holds, fails, undecided };
std::string_view toString(ClaimVerdict verdict);  // as in the results file's claim table

ClaimRecord judgeClaim(const Claim& claim, const CampaignResults& results);

// The study's findings on the scenes of this campaign. None where iterations were counted: the findings are about time.
std::vector<ClaimRecord> judgeStudyClaims(const CampaignResults& results);

}  // namespace wavecrest
