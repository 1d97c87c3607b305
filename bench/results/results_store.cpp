#include "bench/results/results_store.h"

#include "bench/results/distinct_values.h"
#include "bench/results/schema.h"
#include "bench/results/within_folder.h"

namespace wavecrest {
namespace {

// Inserts the snapshots of a run with their measurements. The caller holds the transaction.
void putSnapshots(Database& database, int64_t run, const std::vector<SnapshotRecord>& snapshots) {
  Statement row(database, "INSERT INTO snapshot VALUES(?, ?, ?, ?, ?)");
  Statement value(database, "INSERT INTO measurement VALUES(?, ?, ?, ?)");
  for (const SnapshotRecord& snapshot : snapshots) {
    row.bind(run, snapshot.number, snapshot.renderSeconds, snapshot.iterations, snapshot.file).run();
    for (const auto& [metric, score] : snapshot.values) value.bind(run, snapshot.number, metric, score).run();
  }
}

// Inserts a run with its stages and snapshots. The caller holds the transaction. Fails by the table's UNIQUE constraint
// if the run is there already. What was found of the method's bias, and of the study's findings, is of the runs before,
// and goes.
void insertRun(Database& database, const RunRecord& run) {
  Statement(database, "DELETE FROM bias WHERE scene = ? AND method = ?").bind(run.scene, run.method).run();
  Statement(database, "DELETE FROM claim").run();
  Statement(database, "INSERT INTO run(scene, method, seed, state, reason, stats) VALUES(?, ?, ?, ?, ?, ?)")
      .bind(run.scene, run.method, run.seed, toString(run.state), run.reason, run.stats)
      .run();
  const int64_t id = sqlite3_last_insert_rowid(database.handle());
  Statement stage(database, "INSERT INTO stage VALUES(?, ?, ?, ?, ?)");
  for (size_t i = 0; i < run.stages.size(); ++i) {
    stage.bind(id, i, run.stages[i].name, run.stages[i].items, run.stages[i].seconds).run();
  }
  putSnapshots(database, id, run.snapshots);
}

}  // namespace

ResultsStore::ResultsStore(const std::filesystem::path& path) : database_(path, OpenFor::writing) {
  createSchema(database_);
}

// Leaves WAL mode, so that no journal stays beside the file. SQLite refuses while another process reads; then the
// journal stays, and the results are as good.
ResultsStore::~ResultsStore() {
  sqlite3_exec(database_.handle(), "PRAGMA journal_mode = DELETE", nullptr, nullptr, nullptr);
}

void ResultsStore::putCampaign(const std::map<std::string, std::string>& values) {
  Transaction transaction(database_);
  Statement row(database_, "INSERT OR REPLACE INTO campaign VALUES(?, ?)");
  for (const auto& [key, value] : values) row.bind(key, value).run();
  transaction.commit();
}

void ResultsStore::addEnvironment(const std::map<std::string, std::string>& values) {
  // Append each value to the list that is stored under its key.
  std::map<std::string, std::string> lists;
  Statement known(database_, "SELECT value FROM campaign WHERE key = ?");
  for (const auto& [key, value] : values) {
    if (known.bind(key).step()) lists[key] = known.text(0);
    addDistinct(lists[key], value);
  }
  putCampaign(lists);
}

void ResultsStore::putScene(const SceneRecord& scene) {
  Transaction transaction(database_);
  // An update in place keeps the rowid, which is the order of scenes.
  Statement(database_,
            "INSERT INTO scene VALUES(?1, ?2, ?3, ?4, ?5) ON CONFLICT(name) DO UPDATE "
            "SET scene_hash = ?2, reference_file = ?3, width = ?4, height = ?5")
      .bind(scene.name, scene.hash, scene.referenceFile, scene.width, scene.height)
      .run();
  // Replace noise floors and path classes as a whole.
  Statement(database_, "DELETE FROM noise_floor WHERE scene = ?").bind(scene.name).run();
  Statement floor(database_, "INSERT INTO noise_floor VALUES(?, ?, ?)");
  for (const auto& [metric, value] : scene.noiseFloors) floor.bind(scene.name, metric, value).run();
  Statement(database_, "DELETE FROM path_class WHERE scene = ?").bind(scene.name).run();
  Statement row(database_, "INSERT INTO path_class VALUES(?, ?, ?, ?)");
  for (const PathClassRecord& entry : scene.pathClasses) {
    row.bind(scene.name, entry.pathClass, entry.method, entry.verdict).run();
  }
  transaction.commit();
}

void ResultsStore::putRun(const RunRecord& run) {
  Transaction transaction(database_);
  insertRun(database_, run);
  transaction.commit();
}

void ResultsStore::replaceRun(const RunRecord& run) {
  // Restricts a deletion to the rows of this run.
  constexpr const char* kThisRun = " WHERE run IN (SELECT id FROM run WHERE scene = ? AND method = ? AND seed = ?)";
  Transaction transaction(database_);
  // Foreign keys ask for this order: rows go before the rows that they refer to.
  for (const char* table : {"measurement", "snapshot", "stage"}) {
    Statement(database_, std::string("DELETE FROM ") + table + kThisRun).bind(run.scene, run.method, run.seed).run();
  }
  Statement(database_, "DELETE FROM run WHERE scene = ? AND method = ? AND seed = ?")
      .bind(run.scene, run.method, run.seed)
      .run();
  insertRun(database_, run);
  transaction.commit();
}

void ResultsStore::putBiases(const std::vector<BiasRecord>& biases) {
  Transaction transaction(database_);
  Statement row(database_, "INSERT OR REPLACE INTO bias VALUES(?, ?, ?, ?, ?, ?, ?)");
  for (const BiasRecord& bias : biases) {
    row.bind(bias.scene, bias.method, bias.number, bias.seeds, bias.meanSquareError, bias.variance, bias.biasSquared)
        .run();
  }
  transaction.commit();
}

void ResultsStore::putClaims(const std::vector<ClaimRecord>& claims) {
  Transaction transaction(database_);
  database_.execute("DELETE FROM claim");
  Statement row(database_, "INSERT INTO claim VALUES(?, ?, ?, ?, ?, ?)");
  for (const ClaimRecord& claim : claims) {
    row.bind(claim.id, claim.scene, claim.statement, claim.verdict, claim.figure, claim.evidence).run();
  }
  transaction.commit();
}

std::optional<std::string> ResultsStore::sceneHash(const std::string& scene) {
  Statement query(database_, "SELECT scene_hash FROM scene WHERE name = ?");
  if (!query.bind(scene).step()) return std::nullopt;
  return query.text(0);
}

std::optional<ResultsStore::KnownRun> ResultsStore::findRun(const std::string& scene, const std::string& method,
                                                            uint64_t seed) {
  Statement query(database_, "SELECT state, stats, id FROM run WHERE scene = ? AND method = ? AND seed = ?");
  if (!query.bind(scene, method, seed).step()) return std::nullopt;
  KnownRun run{.state = query.text(0) == toString(RunState::refused) ? RunState::refused : RunState::done,
               .stats = query.text(1),
               .images = {}};
  Statement images(database_, "SELECT file FROM snapshot WHERE run = ? AND file <> ''");
  images.bind(query.integer(2));
  while (images.step()) {
    run.images.push_back(images.text(0));
    withinFolder(database_.path().parent_path(), run.images.back());
  }
  return run;
}

}  // namespace wavecrest
