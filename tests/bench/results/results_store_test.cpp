// What is written into a results file comes back, whole runs at a time; and shards come back as one campaign.
#include "bench/results/results_store.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "bench/results/read_results.h"
#include "tests/metrics/temporary_folder.h"

namespace wavecrest {
namespace {

using test::TemporaryFolder;

SceneRecord sampleScene(const std::string& name = "box") {
  return {.name = name,
          .hash = "00ff",
          .referenceFile = "references/" + name + ".exr",
          .width = 32,
          .height = 24,
          .noiseFloors = {{"rmse", 0.001}, {"ssim", 0.999}},
          .pathClasses = {{"L D E", "pt", "sampled"}, {"L S D E", "pt", "inefficient"}}};
}

RunRecord sampleRun(const std::string& scene = "box", const std::string& method = "pt", uint64_t seed = 1) {
  return {.scene = scene,
          .method = method,
          .seed = seed,
          .stats = R"({"threads":2})",
          .stages = {{"generate", 100, 0.25}, {"extend", 90, 0.5}},
          .snapshots = {{.number = 0,
                         .renderSeconds = 0.1,
                         .iterations = 1,
                         .file = "images/a.0000.exr",
                         .values = {{"rmse", 0.5}, {"ssim", 0.25}}},
                        {.number = 1,
                         .renderSeconds = 0.3,
                         .iterations = 4,
                         .file = "images/a.0001.exr",
                         .values = {{"rmse", 0.25}, {"ssim", std::numeric_limits<double>::quiet_NaN()}}}}};
}

TEST(ResultsStore, whatIsWrittenIsReadBack) {
  const TemporaryFolder folder;
  const RunRecord run = sampleRun("box", "pt", 0xffffffffffffffffu);
  {
    ResultsStore store(folder.path("results.sqlite"));
    store.putCampaign({{"profile", "quick"}, {"threads", "2"}});
    store.putScene(sampleScene());
    store.putRun(run);
    store.putBiases({{"box", "pt", 1, 2, 3, 2, 1}});
    store.putClaims({{"c1", "box", "pt wins", "not judged", "no light", "pt 0.1, lt 0.2"}});
  }
  const CampaignResults results = readResults(folder.folder());
  EXPECT_EQ(results.campaign.at("profile"), "quick");
  ASSERT_EQ(results.scenes.size(), 1u);
  const SceneRecord& scene = results.scenes[0];
  EXPECT_EQ(scene.referenceFile, (folder.folder() / "references/box.exr").string());
  EXPECT_EQ(scene.hash, "00ff");
  EXPECT_EQ(scene.height, 24u);
  EXPECT_EQ(scene.noiseFloors, sampleScene().noiseFloors);
  ASSERT_EQ(scene.pathClasses.size(), 2u);
  EXPECT_EQ(scene.pathClasses[1].verdict, "inefficient");
  ASSERT_EQ(results.runs.size(), 1u);
  const RunRecord& read = results.runs[0];
  EXPECT_EQ(read.seed, run.seed) << "a seed keeps all 64 bits";
  EXPECT_EQ(read.stats, run.stats);
  ASSERT_EQ(read.stages.size(), 2u);
  EXPECT_EQ(read.stages[1].name, "extend");
  EXPECT_EQ(read.stages[1].items, 90u);
  EXPECT_EQ(read.stages[1].seconds, 0.5);
  ASSERT_EQ(read.snapshots.size(), 2u);
  EXPECT_EQ(read.snapshots[1].iterations, 4u);
  EXPECT_EQ(read.snapshots[1].renderSeconds, 0.3);
  EXPECT_EQ(read.snapshots[1].file, (folder.folder() / "images/a.0001.exr").string());
  EXPECT_EQ(read.snapshots[0].values, run.snapshots[0].values);
  EXPECT_TRUE(std::isnan(read.snapshots[1].values.at("ssim")));
  ASSERT_EQ(results.biases.size(), 1u);
  EXPECT_EQ(results.biases[0].biasSquared, 1);
  EXPECT_EQ(results.biases[0].seeds, 2u);
  ASSERT_EQ(results.claims.size(), 1u);
  EXPECT_EQ(results.claims[0].verdict, "not judged");
  EXPECT_EQ(results.claims[0].figure, "no light");
  EXPECT_EQ(results.claims[0].evidence, "pt 0.1, lt 0.2");
}

// Files of version 1: claims had no figure.
TEST(ResultsStore, aFileOfTheOldestVersionIsReadAndBroughtUpToDate) {
  const TemporaryFolder folder;
  const std::string path = folder.path("results.sqlite");
  {
    ResultsStore store(path);
    store.putScene(sampleScene());
    store.putRun(sampleRun());
  }
  {
    Database database(path, OpenFor::writing);
    database.execute(
        "DROP TABLE claim; CREATE TABLE claim(id TEXT PRIMARY KEY, scene TEXT NOT NULL, statement TEXT NOT NULL, "
        "verdict TEXT NOT NULL CHECK(verdict IN ('holds', 'does not hold', 'undecided')), evidence TEXT NOT NULL); "
        "INSERT INTO claim VALUES('c1', 'box', 'pt wins', 'holds', 'pt 0.1'); PRAGMA user_version = 1");
  }
  EXPECT_EQ(readResults(path).claims.at(0).evidence, "pt 0.1");
  { const ResultsStore store(path); }
  const ClaimRecord claim = readResults(path).claims.at(0);
  EXPECT_EQ(claim.verdict, "holds");
  EXPECT_EQ(claim.figure, "");
  { ResultsStore(path).putClaims({{"c2", "box", "lt wins", "not judged", "no light", ""}}); }
  EXPECT_EQ(readResults(path).claims.at(0).id, "c2");
  EXPECT_EQ(readResults(path).runs.size(), 1u) << "the rest stays";
}

// Version 2, which had no verdict "not reached in this time".
TEST(ResultsStore, aFileOfTheVersionBeforeIsReadAndBroughtUpToDate) {
  const TemporaryFolder folder;
  const std::string path = folder.path("results.sqlite");
  { const ResultsStore store(path); }
  {
    Database database(path, OpenFor::writing);
    database.execute(
        "DROP TABLE claim; CREATE TABLE claim(id TEXT PRIMARY KEY, scene TEXT NOT NULL, statement TEXT NOT NULL, "
        "verdict TEXT NOT NULL CHECK(verdict IN ('holds', 'does not hold', 'undecided', 'not judged')), "
        "figure TEXT NOT NULL, evidence TEXT NOT NULL); "
        "INSERT INTO claim VALUES('c1', 'box', 'pt wins', 'holds', 'pt 0.1', 'pt 0.1, lt 0.2'); "
        "PRAGMA user_version = 2");
  }
  EXPECT_EQ(readResults(path).claims.at(0).figure, "pt 0.1");
  { const ResultsStore store(path); }
  EXPECT_EQ(readResults(path).claims.at(0).figure, "pt 0.1");
  EXPECT_EQ(readResults(path).claims.at(0).evidence, "pt 0.1, lt 0.2");
  { ResultsStore(path).putClaims({{"c2", "box", "lt wins", "not reached in this time", "after 9 s", ""}}); }
  EXPECT_EQ(readResults(path).claims.at(0).verdict, "not reached in this time");
}

TEST(ResultsStore, aRefusalIsARunWithAReason) {
  const TemporaryFolder folder;
  {
    ResultsStore store(folder.path("results.sqlite"));
    store.putScene(sampleScene());
    store.putRun({.scene = "box", .method = "bpt", .seed = 1, .state = RunState::refused, .reason = "cannot"});
  }
  const RunRecord run = readResults(folder.folder()).runs.at(0);
  EXPECT_EQ(run.state, RunState::refused);
  EXPECT_EQ(run.reason, "cannot");
}

TEST(ResultsStore, aRunThatIsThereIsRefusedAndLeavesNoTrace) {
  const TemporaryFolder folder;
  ResultsStore store(folder.path("results.sqlite"));
  store.putScene(sampleScene());
  store.putRun(sampleRun());
  EXPECT_TRUE(store.findRun("box", "pt", 1));
  EXPECT_FALSE(store.findRun("box", "pt", 2));
  EXPECT_THROW(store.putRun(sampleRun()), ResultsFileError);
  EXPECT_EQ(readResults(folder.folder()).runs.size(), 1u);
}

TEST(ResultsStore, aRunThatFailsHalfwayIsNotThereAtAll) {
  const TemporaryFolder folder;
  ResultsStore store(folder.path("results.sqlite"));
  store.putScene(sampleScene());
  RunRecord run = sampleRun();
  run.snapshots[1].number = run.snapshots[0].number;  // after one snapshot has been written
  EXPECT_THROW(store.putRun(run), ResultsFileError);
  EXPECT_FALSE(store.findRun("box", "pt", 1));
  EXPECT_TRUE(readResults(folder.folder()).runs.empty());
}

TEST(ResultsStore, aRunInPlaceOfAnotherTakesThatOnesBiasAway) {
  const TemporaryFolder folder;
  {
    ResultsStore store(folder.path("results.sqlite"));
    store.putScene(sampleScene());
    store.putRun(sampleRun("box", "pt"));
    store.putRun(sampleRun("box", "lt"));
    store.putBiases({{"box", "pt", 1, 2, 3, 2, 1}, {"box", "lt", 1, 2, 3, 2, 1}});
    RunRecord longer = sampleRun("box", "pt");
    longer.snapshots.resize(1);
    store.replaceRun(longer);
  }
  const CampaignResults results = readResults(folder.folder());
  EXPECT_EQ(results.runs.size(), 2u);
  ASSERT_EQ(results.biases.size(), 1u);
  EXPECT_EQ(results.biases[0].method, "lt");
}

TEST(ResultsStore, aRunOfAnotherSeedTakesTheMethodsBiasAndVerdictsAway) {
  const TemporaryFolder folder;
  ResultsStore store(folder.path("results.sqlite"));
  store.putScene(sampleScene());
  for (uint64_t seed = 1; seed <= 2; ++seed) store.putRun(sampleRun("box", "pt", seed));
  store.putBiases({{"box", "pt", 1, 2, 3, 2, 1}, {"box", "lt", 1, 2, 3, 2, 1}});
  store.putClaims({{"c1", "box", "pt wins", "holds", "by far", "pt 0.1, lt 0.2"}});
  store.putRun(sampleRun("box", "pt", 3));
  const CampaignResults results = readResults(folder.folder());
  EXPECT_TRUE(results.claims.empty()) << "verdicts on runs that were fewer";
  ASSERT_EQ(results.biases.size(), 1u);
  EXPECT_EQ(results.biases[0].method, "lt");
}

TEST(ResultsStore, aRunNeedsItsScene) {
  const TemporaryFolder folder;
  ResultsStore store(folder.path("results.sqlite"));
  EXPECT_THROW(store.putRun(sampleRun()), ResultsFileError);
}

TEST(ResultsStore, openingAgainGoesOn) {
  const TemporaryFolder folder;
  for (uint64_t seed = 1; seed <= 2; ++seed) {
    ResultsStore store(folder.path("results.sqlite"));
    store.putScene(sampleScene());  // a second time: replaced, its runs stay
    store.putRun(sampleRun("box", "pt", seed));
  }
  const CampaignResults results = readResults(folder.folder());
  EXPECT_EQ(results.scenes.size(), 1u);
  EXPECT_EQ(results.scenes[0].noiseFloors.size(), 2u);
  EXPECT_EQ(results.runs.size(), 2u);
}

TEST(ResultsStore, aFileThatWasBegunAndLeftEmptyIsTaken) {
  const TemporaryFolder folder;
  { Database(folder.path("results.sqlite"), OpenFor::writing).execute("PRAGMA journal_mode = WAL"); }
  { ResultsStore(folder.path("results.sqlite")).putScene(sampleScene()); }
  EXPECT_EQ(readResults(folder.folder()).scenes.size(), 1u);
}

TEST(ResultsStore, aFinishedFileNeedsNoJournalBesideIt) {
  const TemporaryFolder folder;
  const std::string path = folder.path("results.sqlite");
  const auto journalMode = [&] {
    Database database(path, OpenFor::reading);
    Statement mode(database, "PRAGMA journal_mode");
    mode.step();
    return mode.text(0);
  };
  {
    ResultsStore store(path);
    store.putCampaign({{"a", "b"}});
    EXPECT_EQ(journalMode(), "wal");
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.folder()), {}), 1);
  EXPECT_EQ(journalMode(), "delete") << "a file in WAL mode cannot be read in a folder that is read-only";
}

// What is said of a statement that fails; empty if it does not.
std::string failureOf(Database& database, const std::string& sql) {
  try {
    database.execute(sql);
  } catch (const ResultsFileError& error) {
    return error.what();
  }
  return {};
}

TEST(Database, tellsAFullDiskALockAndAReadOnlyFileFromADamagedOne) {
  const TemporaryFolder folder;
  const std::string path = folder.path("a.sqlite");
  Database database(path, OpenFor::writing);
  database.execute("CREATE TABLE t(a); PRAGMA max_page_count = 1");  // no fewer than there are
  const std::string full = failureOf(database, "INSERT INTO t VALUES(zeroblob(1000000))");
  EXPECT_NE(full.find("expected a writable place with room"), std::string::npos) << full;
  Database reader(path, OpenFor::reading);
  const std::string readOnly = failureOf(reader, "INSERT INTO t VALUES(1)");
  EXPECT_NE(readOnly.find("expected a writable place with room"), std::string::npos) << readOnly;
  Database other(path, OpenFor::writing);
  sqlite3_busy_timeout(other.handle(), 0);
  database.execute("BEGIN IMMEDIATE");
  const std::string locked = failureOf(other, "BEGIN IMMEDIATE");
  EXPECT_NE(locked.find("expected no other program at work on it"), std::string::npos) << locked;
  const std::string wrong = failureOf(other, "SELECT a FROM none");
  EXPECT_NE(wrong.find("expected an intact results file"), std::string::npos) << wrong;
}

TEST(ReadResults, otherFilesAreRefused) {
  const TemporaryFolder folder;
  EXPECT_THROW(readResults(folder.folder() / "none.sqlite"), ResultsFileError);
  EXPECT_THROW(readResults(folder.write("text.sqlite", "this is no database, and long enough to be seen as none")),
               ResultsFileError);
  {
    Database other(folder.path("other.sqlite"), OpenFor::writing);
    other.execute("CREATE TABLE t(a)");
  }
  EXPECT_THROW(readResults(folder.path("other.sqlite")), ResultsFileError);
  EXPECT_THROW(ResultsStore(folder.path("other.sqlite")), ResultsFileError);
  {
    Database newer(folder.path("newer.sqlite"), OpenFor::writing);
    newer.execute("PRAGMA user_version = 99");
  }
  const auto journalMode = [&] {
    Database newer(folder.path("newer.sqlite"), OpenFor::reading);
    Statement mode(newer, "PRAGMA journal_mode");
    mode.step();
    return mode.text(0);
  };
  EXPECT_THROW(readResults(folder.path("newer.sqlite")), ResultsFileError);
  EXPECT_THROW(ResultsStore(folder.path("newer.sqlite")), ResultsFileError);
  EXPECT_EQ(journalMode(), "delete") << "what is refused stays as it was";
}

// A shard with one run.
std::filesystem::path shard(const TemporaryFolder& folder, const std::string& name, const RunRecord& run,
                            const std::map<std::string, std::string>& campaign, const SceneRecord& scene) {
  std::filesystem::path path = folder.path(name);
  ResultsStore store(path);
  store.putCampaign(campaign);
  store.putScene(scene);
  store.putRun(run);
  store.putClaims({{"c1", "box", "pt wins", "undecided", "only one method"}});
  return path;
}

TEST(ReadResults, shardsComeBackAsOneCampaign) {
  const TemporaryFolder folder;
  const std::array paths{
      shard(folder, "b.sqlite", sampleRun("room", "pt", 1), {{"spp", "4"}, {"cpu", "y"}}, sampleScene("room")),
      shard(folder, "a.sqlite", sampleRun("box", "pt", 1), {{"spp", "4"}, {"cpu", "x"}}, sampleScene()),
      shard(folder, "c.sqlite", sampleRun("box", "lt", 1), {{"spp", "4"}, {"cpu", "x"}}, sampleScene())};
  const CampaignResults results = readResults(paths);
  EXPECT_EQ(results.campaign.at("spp"), "4");
  EXPECT_EQ(results.campaign.at("cpu"), "y, x");
  ASSERT_EQ(results.scenes.size(), 2u);
  EXPECT_EQ(results.scenes[0].name, "box");
  ASSERT_EQ(results.runs.size(), 3u);
  EXPECT_NE(results.findRun("box", "lt", 1), nullptr);
  EXPECT_EQ(results.runs[2].scene, "room");
  EXPECT_TRUE(results.claims.empty()) << "no shard can judge the whole";
}

// A shard that was resumed on another machine lists both.
TEST(ReadResults, valuesOfShardsThatListSeveralAreNamedOnce) {
  const TemporaryFolder folder;
  const std::array paths{shard(folder, "a.sqlite", sampleRun("box", "pt"), {{"cpu", "x, y"}}, sampleScene()),
                         shard(folder, "b.sqlite", sampleRun("box", "lt"), {{"cpu", "y, z"}}, sampleScene())};
  EXPECT_EQ(readResults(paths).campaign.at("cpu"), "x, y, z");
}

TEST(ReadResults, aNoiseFloorThatIsNoNumberIsTheSameInAllShards) {
  const TemporaryFolder folder;
  SceneRecord scene = sampleScene();
  scene.noiseFloors["q"] = std::numeric_limits<double>::quiet_NaN();
  const std::array paths{shard(folder, "a.sqlite", sampleRun("box", "pt"), {{"spp", "4"}}, scene),
                         shard(folder, "b.sqlite", sampleRun("box", "lt"), {{"spp", "4"}}, scene)};
  EXPECT_EQ(readResults(paths).runs.size(), 2u);
}

TEST(ReadResults, aFolderStandsForItsFileOrItsShards) {
  const TemporaryFolder folder;
  shard(folder, "results.1-of-2.sqlite", sampleRun("box", "pt", 1), {{"spp", "4"}}, sampleScene());
  shard(folder, "results.2-of-2.sqlite", sampleRun("box", "lt", 1), {{"spp", "4"}}, sampleScene());
  EXPECT_EQ(readResults(folder.folder()).runs.size(), 2u);
  EXPECT_TRUE(holdsResults(folder.folder()));
  EXPECT_FALSE(holdsResults(TemporaryFolder().folder()));
  shard(folder, "results.sqlite", sampleRun("box", "vcm", 1), {{"spp", "4"}}, sampleScene());
  EXPECT_EQ(readResults(folder.folder()).runs.size(), 1u);
}

TEST(ReadResults, whatIsNoPartOfTheSameCampaignIsRefused) {
  const TemporaryFolder folder;
  SceneRecord changed = sampleScene(), noisier = sampleScene();
  changed.hash = "00fe";
  noisier.noiseFloors["rmse"] = 0.5;
  const auto first = shard(folder, "0.sqlite", sampleRun(), {{"spp", "4"}}, sampleScene());
  const RunRecord other = sampleRun("box", "lt", 1);
  const std::array others{shard(folder, "1.sqlite", sampleRun(), {{"spp", "4"}}, sampleScene()),
                          shard(folder, "2.sqlite", other, {{"spp", "8"}}, sampleScene()),
                          shard(folder, "3.sqlite", other, {{"spp", "4"}}, changed),
                          shard(folder, "4.sqlite", other, {{"spp", "4"}}, noisier)};
  for (const std::filesystem::path& path : others) {
    EXPECT_THROW(readResults(std::array{first, path}), ResultsFileError) << path;
  }
}

}  // namespace
}  // namespace wavecrest
