// Judges claims on the results of a campaign: holds, does not hold, not reached in this time, undecided, or not
// judged here.
//
// Losses are compared by their logarithms at the end of runs of equal render time, times to equal quality likewise,
// with 95 % bands from the seeds; a single seed gets the spread between the two seeds of the standard campaign
// (scene_losses.h). What the bands leave open is undecided. A score that is missed for want of time alone
// (reached_later.h) is not reached in this time. A claim is not judged, and counts for nothing, where the
// campaign lacks what the claim is about: light paths, time, methods, a control, or a reference clean enough to see a
// difference.
#pragma once

#include <vector>

#include "bench/claims/claim_list.h"
#include "wavecrest/results.h"

namespace wavecrest {

// From the lightest to the heaviest: the heaviest decides a conjunction.
enum class ClaimVerdict { holds, undecided, notJudged, notReached, fails };
std::string_view toString(ClaimVerdict verdict);  // as in the results file's claim table

ClaimRecord judgeClaim(const Claim& claim, const CampaignResults& results);

// The study's findings on the scenes of this campaign. None where iterations were counted: the findings are about time.
std::vector<ClaimRecord> judgeStudyClaims(const CampaignResults& results);

}  // namespace wavecrest
