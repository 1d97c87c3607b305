// The tables of a results file, and their version. bench/results/README.md says what each column means.
#pragma once

#include "bench/results/database.h"

namespace wavecrest {

constexpr int kResultsVersion = 1;  // of the schema, in PRAGMA user_version

// Makes the tables in a file without any, be it new or left by a process that died before it made them; leaves a file
// of this version as it is. Throws ResultsFileError for any other file.
void createSchema(Database& database);

// Throws ResultsFileError unless the file has tables of this version.
void requireSchema(Database& database);

}  // namespace wavecrest
