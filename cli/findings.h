// What `--check` prints of the study's findings, and the exit code that follows from them.
#pragma once

#include <span>

#include "bench/report/report_data.h"
#include "cli/progress.h"

namespace wavecrest {

// A line for each finding on stdout, and on stderr one for each that does not hold: then the exit code is kExitCheck.
// Undecided ones are no failure, nor are those not reached in this time or not judged; but where none was judged
// nothing was checked, which is one. kind: of the lines on stderr.
int showFindings(std::span<const ReportClaim> claims, ProgressKind kind = ProgressKind::automatic);

}  // namespace wavecrest
