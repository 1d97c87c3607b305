// Makes a report's data from the results of a campaign (bench/results): nothing is measured again; of the images only
// those at the end of runs are read.
#pragma once

#include "bench/report/report_data.h"
#include "wavecrest/results.h"

namespace wavecrest {

/// Images that are not there are left out with a remark, as results files travel without them. Throws ImageError if one
/// is there but cannot be read.
ConvergenceReport collectCampaign(const CampaignResults& results);

}  // namespace wavecrest
