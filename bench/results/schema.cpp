#include "bench/results/schema.h"

namespace wavecrest {
namespace {

// All tables but `claim`, which older files have in another form. NULL in a column of metric values stands for NaN.
// Tables with a rowid are read in the order of insertion.
constexpr const char* kTables = R"(
CREATE TABLE campaign(key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE scene(
  name TEXT PRIMARY KEY,
  scene_hash TEXT NOT NULL,
  reference_file TEXT NOT NULL,
  width INTEGER NOT NULL,
  height INTEGER NOT NULL);
CREATE TABLE noise_floor(
  scene TEXT NOT NULL REFERENCES scene(name),
  metric TEXT NOT NULL,
  value REAL,
  PRIMARY KEY(scene, metric)) WITHOUT ROWID;
CREATE TABLE path_class(
  scene TEXT NOT NULL REFERENCES scene(name),
  class TEXT NOT NULL,
  method TEXT NOT NULL,
  verdict TEXT NOT NULL CHECK(verdict IN ('sampled', 'inefficient', 'impossible')),
  PRIMARY KEY(scene, class, method));
CREATE TABLE run(
  id INTEGER PRIMARY KEY,
  scene TEXT NOT NULL REFERENCES scene(name),
  method TEXT NOT NULL,
  seed INTEGER NOT NULL,
  state TEXT NOT NULL CHECK(state IN ('done', 'refused')),
  reason TEXT NOT NULL,
  stats TEXT NOT NULL,
  UNIQUE(scene, method, seed));
CREATE TABLE stage(
  run INTEGER NOT NULL REFERENCES run(id),
  position INTEGER NOT NULL,
  name TEXT NOT NULL,
  items INTEGER NOT NULL,
  seconds REAL NOT NULL,
  PRIMARY KEY(run, position)) WITHOUT ROWID;
CREATE TABLE snapshot(
  run INTEGER NOT NULL REFERENCES run(id),
  number INTEGER NOT NULL,
  render_seconds REAL NOT NULL,
  iterations INTEGER NOT NULL,
  file TEXT NOT NULL,
  PRIMARY KEY(run, number)) WITHOUT ROWID;
CREATE TABLE measurement(
  run INTEGER NOT NULL,
  number INTEGER NOT NULL,
  metric TEXT NOT NULL,
  value REAL,
  PRIMARY KEY(run, number, metric),
  FOREIGN KEY(run, number) REFERENCES snapshot(run, number)) WITHOUT ROWID;
CREATE TABLE bias(
  scene TEXT NOT NULL REFERENCES scene(name),
  method TEXT NOT NULL,
  number INTEGER NOT NULL,
  seeds INTEGER NOT NULL,
  mean_square_error REAL,
  variance REAL,
  bias_squared REAL,
  PRIMARY KEY(scene, method, number)) WITHOUT ROWID;
)";

constexpr const char* kClaimTable = R"(
CREATE TABLE claim(
  id TEXT PRIMARY KEY,
  scene TEXT NOT NULL,
  statement TEXT NOT NULL,
  verdict TEXT NOT NULL CHECK(verdict IN
    ('holds', 'does not hold', 'not reached in this time', 'undecided', 'not judged')),
  figure TEXT NOT NULL,
  evidence TEXT NOT NULL);
)";

// Claims of version 1 have no figure, and older versions know fewer verdicts: none "not reached in this time", version
// 1 none "not judged". The table is set aside, and its rows are copied into a new one.
std::string newClaimTable(int64_t version) {
  const std::string figure = version == kOldestResultsVersion ? "''" : "figure";
  return std::string("ALTER TABLE claim RENAME TO older_claim;") + kClaimTable +
         "INSERT INTO claim SELECT id, scene, statement, verdict, " + figure +
         ", evidence FROM older_claim ORDER BY rowid; DROP TABLE older_claim;";
}

// The version of the schema. SQLite gives 0 for a file in which none was set.
int64_t versionOf(Database& database) {
  Statement version(database, "PRAGMA user_version");
  version.step();
  return version.integer(0);
}

bool hasTables(Database& database) {
  Statement tables(database, "SELECT count(*) FROM sqlite_master");
  return tables.step() && tables.integer(0) != 0;
}

// Throws for a version that cannot be read.
[[noreturn]] void failVersion(const Database& database, int64_t version) {
  throw ResultsFileError(database.path().string() + ": has results of version " + std::to_string(version) +
                         "; expected version " + std::to_string(kOldestResultsVersion) + " to " +
                         std::to_string(kResultsVersion));
}

// The version of the results in the file; 0 if the file is new. Throws for a version that cannot be read, and for a
// database of another program.
int64_t requireOurs(Database& database) {
  const int64_t version = versionOf(database);
  const bool isNew = version == 0 && !hasTables(database);
  if (!isNew && (version < kOldestResultsVersion || version > kResultsVersion)) failVersion(database, version);
  return version;
}

}  // namespace

void createSchema(Database& database) {
  const std::string setVersion = "PRAGMA user_version = " + std::to_string(kResultsVersion);
  // The journal mode stays in the file, so a database of another program is refused before it is set.
  requireOurs(database);
  // One writer, readers beside it, and a file that is whole after a power cut.
  database.execute("PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; PRAGMA foreign_keys = ON");
  // Read the version inside the transaction, so that two processes cannot both make the tables.
  Transaction transaction(database);
  const int64_t version = requireOurs(database);
  if (version == 0) {
    database.execute(std::string(kTables) + kClaimTable + setVersion);
  } else if (version < kResultsVersion) {
    database.execute(newClaimTable(version) + setVersion);
  }
  transaction.commit();
}

void requireSchema(Database& database) {
  if (requireOurs(database) == 0) failVersion(database, 0);
}

bool hasClaimFigures(Database& database) { return versionOf(database) > kOldestResultsVersion; }

}  // namespace wavecrest
