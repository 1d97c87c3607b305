// A run leaves its snapshots, their values, and what it cost; with counted iterations it repeats to the bit.
#include "bench/campaign/measured_run.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "bench/checkpoint/checkpoint.h"
#include "engine/load/load.h"
#include "engine/state/state_stream.h"
#include "metrics/image/image_io.h"
#include "scenes/scene_list.h"
#include "tests/metrics/temporary_folder.h"

namespace wavecrest {
namespace {

class MeasuredRunTest : public testing::Test {
 protected:
  MeasuredRunTest() {
    LoadOptions options;
    options.filmSize = {{32, 24}};
    scene_ = loadScene(findScene("cornell-diffuse"), options);
    std::filesystem::create_directories(folder_.folder() / "images");
  }
  std::optional<RunRecord> run(Method method, uint64_t iterations, bool keepImages = true) {
    return run(method, iterations, std::nullopt, SnapshotSchedule::doubling(), keepImages);
  }
  std::optional<RunRecord> run(Method method, std::optional<uint64_t> iterations, std::optional<double> seconds,
                               const SnapshotSchedule& schedule, bool keepImages = true) {
    RenderSettings settings;
    settings.method = method;
    settings.metropolis.variant = variant_;
    settings.seed = 3;
    settings.isa = bestIsa();
    settings.threads = 2;
    settings.measureStages = true;
    settings.waveSize = 64;
    settings.iterations = iterations;
    settings.seconds = seconds;
    std::optional<RunRecord> run = measuredRun({.scene = scene_,
                                                .settings = settings,
                                                .schedule = schedule,
                                                .reference = reference_,
                                                .out = folder_.folder(),
                                                .keepImages = keepImages,
                                                .checkpoint = checkpoint_,
                                                .say = [&](const std::string& line) { said_.push_back(line); }},
                                               {.watch = watch_});
    if (run) placeImages(folder_.folder(), *run);
    return run;
  }
  size_t imageCount() const {
    return static_cast<size_t>(std::distance(std::filesystem::directory_iterator(folder_.folder() / "images"), {}));
  }

  const test::TemporaryFolder folder_;
  Scene scene_;
  const PreparedReference reference_{
      "grey", {{.width = 32, .height = 24, .channels = 3, .pixels = std::vector<float>(3 * 32 * 24, 0.3f)}, {}, {}}};
  std::function<void(Session*)> watch_;
  std::filesystem::path checkpoint_;
  std::vector<std::string> said_;
  MetropolisVariant variant_ = MetropolisVariant::mmlt;
};

TEST_F(MeasuredRunTest, snapshotsDoubleAndEndWithTheLastIteration) {
  const RunRecord run = this->run(Method::pt, 5).value();
  ASSERT_EQ(run.snapshots.size(), 4u);
  const uint64_t expected[] = {1, 2, 4, 5};
  for (unsigned i = 0; i < 4; ++i) {
    EXPECT_EQ(run.snapshots[i].number, i);
    EXPECT_EQ(run.snapshots[i].iterations, expected[i]);
    EXPECT_EQ(run.snapshots[i].file, "images/cornell-diffuse.pt.3.000" + std::to_string(i) + ".exr");
    EXPECT_GE(run.snapshots[i].renderSeconds, i > 0 ? run.snapshots[i - 1].renderSeconds : 0);
  }
  EXPECT_EQ(this->run(Method::pt, 4).value().snapshots.size(), 3u) << "the end is not taken twice";
}

TEST_F(MeasuredRunTest, valuesAreThoseOfTheImages) {
  const RunRecord run = this->run(Method::bpt, 2).value();
  for (const SnapshotRecord& snapshot : run.snapshots) {
    const Image image = readImage((folder_.folder() / snapshot.file).string()).image;
    EXPECT_EQ(measureImage(reference_, "again", image), snapshot.values);
  }
  EXPECT_NE(run.snapshots[0].values.at("rmse"), run.snapshots[1].values.at("rmse"));
  for (const char* name : {"rmse", "relmse", "ssim", "q_mos", "q", "flip"}) {
    EXPECT_TRUE(run.snapshots[0].values.contains(name)) << name;
  }
}

TEST_F(MeasuredRunTest, statisticsAreThoseOfTheWholeRun) {
  const RunRecord run = this->run(Method::pt, 5).value();
  const nlohmann::json stats = nlohmann::json::parse(run.stats);
  EXPECT_EQ(stats.at("iterations"), 5);
  EXPECT_EQ(stats.at("camera_paths"), 5 * 32 * 24);
  EXPECT_EQ(stats.at("seed"), 3);
  EXPECT_FALSE(stats.at("cpu").get<std::string>().empty());
  EXPECT_FALSE(stats.contains("peak_memory_bytes")) << "which is of all runs of the process";
  ASSERT_FALSE(run.stages.empty());
  EXPECT_EQ(run.stages[0].items, 5u * 32 * 24);
}

TEST_F(MeasuredRunTest, onlyTheLastImageIsKeptIfThatIsAskedFor) {
  const RunRecord run = this->run(Method::pt, 5, false).value();
  EXPECT_EQ(imageCount(), 1u);
  ASSERT_EQ(run.snapshots.size(), 4u);
  EXPECT_TRUE(run.snapshots[2].file.empty());
  EXPECT_TRUE(std::filesystem::exists(folder_.folder() / run.snapshots[3].file));
  EXPECT_TRUE(run.snapshots[0].values.contains("rmse"));
}

TEST_F(MeasuredRunTest, repeatsToTheBit) {
  for (const MethodEntry& method : kMethods) {
    const RunRecord first = run(method.method, 3).value(), second = run(method.method, 3).value();
    ASSERT_EQ(first.snapshots.size(), second.snapshots.size()) << method.name;
    for (size_t i = 0; i < first.snapshots.size(); ++i) {
      EXPECT_EQ(first.snapshots[i].values, second.snapshots[i].values) << method.name;
    }
  }
}

TEST_F(MeasuredRunTest, aRefusalSaysWhy) {
  scene_.sensor.kind = Sensor::Kind::thinlens;
  variant_ = MetropolisVariant::pathspace;
  const RunRecord run = this->run(Method::mlt, 1).value();
  EXPECT_EQ(run.state, RunState::refused);
  EXPECT_NE(run.reason.find("pathspace needs a pinhole"), std::string::npos) << run.reason;
  EXPECT_TRUE(run.snapshots.empty());
}

// The first snapshot is due before a wave of 64 paths can be over.
TEST_F(MeasuredRunTest, snapshotsBeginWithTheFirstWholeImage) {
  const RunRecord run = this->run(Method::bpt, 1, std::nullopt, SnapshotSchedule::every(5e-5)).value();
  ASSERT_FALSE(run.snapshots.empty());
  EXPECT_GT(run.snapshots.front().number, 0u);
  for (const SnapshotRecord& snapshot : run.snapshots) EXPECT_GT(snapshot.iterations, 0u) << snapshot.number;
  EXPECT_LE(nlohmann::json::parse(run.stats).at("snapshots_left_out").get<unsigned>(), run.snapshots.front().number);
}

// Many snapshots are due within an iteration with a photon map, which is finished once it has begun.
TEST_F(MeasuredRunTest, anImageIsMeasuredOnceUnderTheLastNumberThatIsDue) {
  const SnapshotSchedule schedule = SnapshotSchedule::every(1e-4);
  const RunRecord run = this->run(Method::vcm, 4, std::nullopt, schedule).value();
  ASSERT_FALSE(run.snapshots.empty());
  uint64_t before = 0;
  for (const SnapshotRecord& snapshot : run.snapshots) {
    EXPECT_GT(snapshot.iterations, before);
    EXPECT_GT(*schedule.due(snapshot.number + 1).seconds, snapshot.renderSeconds);
    before = snapshot.iterations;
  }
  EXPECT_EQ(before, 4u);
}

// One iteration with a photon map passes the only snapshot that is due, and the end.
TEST_F(MeasuredRunTest, runsOfOneTimeEndWithOneNumber) {
  RunRecord run;
  run.state = RunState::refused;
  double seconds = 1e-4;
  checkpoint_ = folder_.folder() / "state";
  while (run.state == RunState::refused) {
    seconds *= 2;
    ASSERT_LT(seconds, 10) << run.reason;
    std::filesystem::remove(checkpoint_);
    run = this->run(Method::vcm, std::nullopt, seconds, SnapshotSchedule::every(0.75 * seconds)).value();
  }
  EXPECT_EQ(run.snapshots.back().number, 1u);
  // A longer run has the image of what was due before the end of the shorter one.
  const auto schedule = SnapshotSchedule::every(0.75 * seconds);
  const RunRecord longer = this->run(Method::vcm, std::nullopt, 8 * seconds, schedule).value();
  EXPECT_EQ(longer.snapshots.front().iterations, run.snapshots.front().iterations);
  checkpoint_.clear();
  // What is due at the end is the end.
  run = this->run(Method::pt, std::nullopt, 0.05, SnapshotSchedule::every(0.05 / 3)).value();
  ASSERT_FALSE(run.snapshots.empty());
  EXPECT_EQ(run.snapshots.back().number, 2u);
}

TEST_F(MeasuredRunTest, aTimeTooShortForOneImageIsRefusedAndTold) {
  for (const MethodEntry& method : kMethods) {
    const RunRecord run = this->run(method.method, std::nullopt, 1e-9, SnapshotSchedule::every(5e-10)).value();
    EXPECT_EQ(run.state, RunState::refused) << method.name;
    EXPECT_TRUE(run.snapshots.empty()) << method.name;
    EXPECT_NE(run.reason.find("too short for one whole image"), std::string::npos) << run.reason;
    EXPECT_EQ(nlohmann::json::parse(run.stats).at("asked_seconds"), 1e-9) << "a longer run is another one";
  }
  EXPECT_EQ(imageCount(), 0u);
}

TEST_F(MeasuredRunTest, anInterruptedRunIsNone) {
  watch_ = [](Session* session) {
    if (session != nullptr) session->interrupt();
  };
  EXPECT_FALSE(run(Method::pt, 100).has_value());
}

TEST_F(MeasuredRunTest, withItsStateALongerRunGoesOnAsIfItHadNotEnded) {
  for (const MethodEntry& method : kMethods) {
    checkpoint_.clear();
    const RunRecord whole = run(method.method, 110).value();
    checkpoint_ = folder_.folder() / "state";
    std::filesystem::remove(checkpoint_);
    // The last snapshot of the shorter run is not due in the longer one.
    EXPECT_EQ(run(method.method, 50).value().snapshots.back().number, 6u) << method.name;
    uint64_t before = 0;
    watch_ = [&](Session* session) {
      if (session != nullptr) before = session->statistics().iterations;
    };
    const RunRecord longer = run(method.method, 110).value();
    watch_ = {};
    EXPECT_GE(before, 50u) << method.name << " begins anew";
    ASSERT_EQ(longer.snapshots.size(), whole.snapshots.size()) << method.name;
    for (size_t i = 0; i < whole.snapshots.size(); ++i) {
      EXPECT_EQ(longer.snapshots[i].number, whole.snapshots[i].number) << method.name;
      EXPECT_EQ(longer.snapshots[i].iterations, whole.snapshots[i].iterations) << method.name;
      EXPECT_EQ(longer.snapshots[i].values, whole.snapshots[i].values) << method.name;
    }
    const auto count = [](const RunRecord& one) { return nlohmann::json::parse(one.stats).at("camera_paths"); };
    EXPECT_EQ(count(longer), count(whole)) << method.name;
  }
  EXPECT_TRUE(said_.empty());
}

TEST_F(MeasuredRunTest, withItsStateAnInterruptedRunGoesOn) {
  const RunRecord whole = run(Method::bpt, 8).value();
  checkpoint_ = folder_.folder() / "state";
  watch_ = [](Session* session) {
    if (session != nullptr) session->interrupt();
  };
  EXPECT_FALSE(run(Method::bpt, 8).has_value());
  EXPECT_TRUE(std::filesystem::exists(checkpoint_));
  watch_ = {};
  EXPECT_EQ(run(Method::bpt, 8).value().snapshots.back().values, whole.snapshots.back().values);
}

TEST_F(MeasuredRunTest, aRunThatIsOverIsNotLostToAnInterrupt) {
  checkpoint_ = folder_.folder() / "state";
  const RunRecord whole = run(Method::pt, 8).value();
  watch_ = [](Session* session) {
    if (session != nullptr) session->interrupt();
  };
  const std::optional<RunRecord> again = run(Method::pt, 8);
  ASSERT_TRUE(again.has_value());
  EXPECT_EQ(again->snapshots.size(), whole.snapshots.size());
}

TEST_F(MeasuredRunTest, aTimedRunDoesNotGoOnOnAnotherProcessor) {
  checkpoint_ = folder_.folder() / "state";
  const auto timed = [&] { return run(Method::pt, std::nullopt, 0.01, SnapshotSchedule::logarithmic()); };
  timed();
  timed();
  EXPECT_TRUE(said_.empty());
  // As another processor of the same instruction set would have left it.
  const Checkpoint checkpoint(checkpoint_.string());
  CheckpointHeader header = checkpoint.header();
  header.notes["conditions"]["cpu"] = "another";
  writeCheckpoint(checkpoint_.string(), header, [&](StateWriter& out) { out.bytes(checkpoint.state()); });
  timed();
  ASSERT_EQ(said_.size(), 1u);
  EXPECT_NE(said_[0].find("had other cpu; the run is rendered anew"), std::string::npos) << said_[0];
}

TEST_F(MeasuredRunTest, aStateOfAnotherRunIsLeftAndTold) {
  checkpoint_ = folder_.folder() / "state";
  run(Method::pt, 5);
  const RunRecord other = run(Method::lt, 6).value();
  ASSERT_EQ(said_.size(), 1u);
  EXPECT_NE(said_[0].find("rendered anew"), std::string::npos) << said_[0];
  EXPECT_EQ(other.snapshots.size(), 4u);
  // Neither a damaged one.
  std::ofstream(checkpoint_) << "no state";
  EXPECT_EQ(run(Method::lt, 6).value().snapshots.back().values, other.snapshots.back().values);
  EXPECT_EQ(said_.size(), 2u);
}

}  // namespace
}  // namespace wavecrest
