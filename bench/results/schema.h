// The tables of a results file, and their version. bench/results/README.md says what each column means.
#pragma once

#include "bench/results/database.h"

namespace wavecrest {

constexpr int kResultsVersion = 3;        // of the schema, in PRAGMA user_version
constexpr int kOldestResultsVersion = 1;  // that can still be read; writers bring it up to date

// Makes the tables in a file without any, be it new or left by a process that died before it made them; leaves a file
// of this version as it is, and brings one of an older version up to date. Throws ResultsFileError for any other
// file.
void createSchema(Database& database);

// Throws ResultsFileError unless the file has tables of a version that can be read.
void requireSchema(Database& database);

// Whether its claims have a figure; those of the oldest version have none.
bool hasClaimFigures(Database& database);

}  // namespace wavecrest
