// Checkpoint files: what comes back, what is refused and in which words, and that no damage goes unnoticed.
#include "bench/checkpoint/checkpoint.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <functional>
#include <random>

#include "engine/pilot/finished_plan.h"
#include "metrics/image/atomic_file.h"
#include "metrics/image/image.h"
#include "tests/engine/render_statistics.h"
#include "tests/engine/test_scenes.h"
#include "tests/metrics/temporary_folder.h"

namespace wavecrest {
namespace {

using Bytes = std::vector<unsigned char>;

// What a step throws, or nothing.
template <class Error>
std::string errorOf(const std::function<void()>& step) {
  try {
    step();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

class CheckpointTest : public testing::Test {
 protected:
  static RenderSettings settingsOf(Method method) {
    RenderSettings settings;
    settings.method = method;
    settings.isa = bestIsa();
    settings.seed = 5;
    settings.waveSize = 64;
    settings.metropolis.chains = 20;
    settings.metropolis.bootstrapSamples = 100;
    settings.limits.maxDepth = 4;
    return settings;
  }
  // The file of a render that was broken after two iterations.
  std::string fileOf(const RenderSettings& settings) const {
    const auto session = Session::create(scene_, settings);
    session->renderUntil(2, std::nullopt);
    writeCheckpoint(folder_.path("file"), scene_, settings, *session, {{"mine", 7}});
    return folder_.path("file");
  }
  // What is wrong with going on from the file with other settings, after "FILE: ".
  std::string refusal(const std::string& file, const Scene& scene, const RenderSettings& settings) const {
    const auto session = Session::create(scene, settings);
    const std::string text = errorOf<CheckpointError>([&] { Checkpoint(file).restore(scene, settings, *session); });
    return text.starts_with(file + ": ") ? text.substr(file.size() + 2) : text;
  }
  void expectDamaged(const Bytes& bytes, const std::string& where) const {
    const std::string file = folder_.write("damaged", std::string(bytes.begin(), bytes.end()));
    const std::string text = errorOf<CheckpointError>([&] { const Checkpoint checkpoint(file); });
    EXPECT_TRUE(text.starts_with(file + ": is ")) << where << ": " << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << where;
  }

  const test::TemporaryFolder folder_;
  const Scene scene_ = sceneFile("cornell-diffuse", 5, 4);
};

TEST_F(CheckpointTest, aRenderGoesOnFromItsFile) {
  for (const MethodEntry& entry : kMethods) {
    const RenderSettings settings = settingsOf(entry.method);
    const Checkpoint checkpoint(fileOf(settings));
    EXPECT_EQ(checkpoint.header().notes.at("mine"), 7);
    RenderSettings other = settings;
    other.threads = 3;
    checkpoint.cutAlike(other);
    const auto session = Session::create(scene_, other);
    checkpoint.restore(scene_, other, *session);
    session->renderUntil(5, std::nullopt);
    EXPECT_EQ(session->film().resolve(), render(scene_, settings, 5)) << entry.name;
  }
}

// On one thread a budget has room for more light paths than on two, which make another image.
TEST_F(CheckpointTest, aRenderWithABudgetGoesOnWithItsLightPaths) {
  const Scene scene = sceneFile("cornell-diffuse", 40, 30);
  RenderSettings settings = settingsOf(Method::vcm);
  settings.threads = 2;
  const MemoryUse whole = planMemory(scene, settings).use;
  settings.memoryBytes = whole.total() - (whole.lightVertices + whole.photonMap) / 2;
  const auto broken = Session::create(scene, settings);
  broken->renderUntil(2, std::nullopt);
  const std::string file = folder_.path("file");
  writeCheckpoint(file, scene, settings, *broken, {{"mine", 7}});

  const Checkpoint checkpoint(file);
  RenderSettings other = settings;
  other.threads = 1;
  checkpoint.cutAlike(other);
  RenderSettings unbound = other;
  unbound.mostLightPaths.reset();
  EXPECT_GT(planMemory(scene, unbound).lightPaths, broken->memoryPlan().lightPaths);
  const auto session = Session::create(scene, other);
  checkpoint.restore(scene, other, *session);
  session->renderUntil(5, std::nullopt);
  EXPECT_EQ(session->film().resolve(), render(scene, settings, 5));
}

TEST_F(CheckpointTest, theFirstSettingThatDiffersIsNamed) {
  struct Change {
    Method method;
    std::string said;
    std::function<void(RenderSettings&)> make;
  };
  const std::vector<Change> changes{
      {Method::pt, "its method is pt, not lt", [](RenderSettings& s) { s.method = Method::lt; }},
      {Method::pt, "its seed is 5, not 6", [](RenderSettings& s) { s.seed = 6; }},
      {Method::pt, "its first_iteration is 0, not 1", [](RenderSettings& s) { s.firstIteration = 1; }},
      {Method::pt, "its sampler is independent, not sobol", [](RenderSettings& s) { s.sampler = SamplerKind::sobol; }},
      {Method::pt, "its precision is float, not double", [](RenderSettings& s) { s.precision = Precision::doubled; }},
      {Method::pt, "its accel is small, not bvh", [](RenderSettings& s) { s.accel = Accel::bvh; }},
      {Method::pt, "its max_depth is 4, not 5", [](RenderSettings& s) { s.limits.maxDepth = 5; }},
      {Method::pt, "its rr_depth is 5, not 2", [](RenderSettings& s) { s.limits.rouletteDepth = 2; }},
      {Method::lt, "its roulette is throughput, not albedo", [](RenderSettings& s) { s.roulette = Roulette::albedo; }},
      {Method::vcm, "its radius is 0.001, not 0.5", [](RenderSettings& s) { s.radius = 0.5; }},
      {Method::ppm, "its radius_alpha is 0.75, not 0.5", [](RenderSettings& s) { s.radiusAlpha = 0.5; }},
      {Method::bpm, "its light_paths is 4096, not 10", [](RenderSettings& s) { s.lightPaths = 10; }},
      {Method::vcm, "its wave is 64, not 128", [](RenderSettings& s) { s.waveSize = 128; }},
      {Method::bpt, "its wave is 64, not 128", [](RenderSettings& s) { s.waveSize = 128; }},
      {Method::mlt, "its specialization is",
       [](RenderSettings& s) { s.metropolis.variant = MetropolisVariant::pssmlt; }},
      {Method::mlt, "its mlt is mmlt, not pathspace",
       [](RenderSettings& s) { s.metropolis.variant = MetropolisVariant::pathspace; }},
      {Method::mlt, "its chains is 20, not 21", [](RenderSettings& s) { s.metropolis.chains = 21; }},
      {Method::mlt, "its bootstrap is 100, not 101", [](RenderSettings& s) { s.metropolis.bootstrapSamples = 101; }},
      {Method::mlt, "its restart is 0, not 9", [](RenderSettings& s) { s.metropolis.restartSteps = 9; }},
      {Method::mlt, "its large_step is 0.3, not 0.5", [](RenderSettings& s) { s.metropolis.largeStep = 0.5; }},
      {Method::mlt, "its path_mutations is", [](RenderSettings& s) { s.metropolis.pathMutations = 1; }},
      {Method::mlt, "its direct_pass is true, not false", [](RenderSettings& s) { s.metropolis.directPass = false; }},
  };
  for (const Change& change : changes) {
    const std::string file = fileOf(settingsOf(change.method));
    RenderSettings changed = settingsOf(change.method);
    change.make(changed);
    const std::string text = refusal(file, scene_, changed);
    EXPECT_TRUE(text.starts_with(change.said)) << text << " instead of " << change.said;
    EXPECT_EQ(text.find('\n'), std::string::npos);
    EXPECT_EQ(refusal(file, scene_, settingsOf(change.method)), "");
  }
}

TEST_F(CheckpointTest, whatChangesNoBitIsFree) {
  const std::string file = fileOf(settingsOf(Method::lt));
  RenderSettings changed = settingsOf(Method::lt);
  changed.threads = 3;
  changed.waveSize = 200;
  changed.radius = 0.7;  // lt merges nothing
  changed.measureStages = true;
  changed.iterations = 100;
  EXPECT_EQ(refusal(file, scene_, changed), "");
}

TEST_F(CheckpointTest, anotherSceneOrSizeIsNamed) {
  const std::string file = fileOf(settingsOf(Method::pt));
  EXPECT_TRUE(
      refusal(file, sceneFile("cornell-mirror", 5, 4), settingsOf(Method::pt)).starts_with("its scene_hash is "));
  EXPECT_TRUE(refusal(file, sceneFile("cornell-diffuse", 4, 5), settingsOf(Method::pt))
                  .starts_with("its size is 5x4, not 4x5"));
}

TEST_F(CheckpointTest, everyTruncationIsNoticed) {
  const Bytes whole = readFileBytes(fileOf(settingsOf(Method::lt)));
  for (size_t length = 0; length < whole.size(); ++length) {
    expectDamaged(Bytes(whole.begin(), whole.begin() + static_cast<ptrdiff_t>(length)),
                  "first " + std::to_string(length) + " bytes");
  }
}

// Single bits everywhere, and runs of random bytes.
TEST_F(CheckpointTest, everyDamageIsNoticed) {
  const Bytes whole = readFileBytes(fileOf(settingsOf(Method::lt)));
  std::mt19937_64 random(1);
  for (size_t at = 0; at < whole.size(); ++at) {
    Bytes bytes = whole;
    bytes[at] ^= static_cast<unsigned char>(1u << random() % 8);
    expectDamaged(bytes, "bit of byte " + std::to_string(at));
  }
  for (int run = 0; run < 500; ++run) {
    Bytes bytes = whole;
    const size_t at = random() % bytes.size(), count = 1 + random() % 100;
    for (size_t i = at; i < std::min(at + count, bytes.size()); ++i) bytes[i] = static_cast<unsigned char>(random());
    if (bytes != whole) expectDamaged(bytes, "bytes from " + std::to_string(at));
  }
}

TEST_F(CheckpointTest, otherFilesAreNoCheckpoints) {
  std::mt19937_64 random(2);
  for (const size_t size : {0u, 1u, 22u, 23u, 31u, 100u, 5000u}) {
    Bytes bytes(size);
    for (unsigned char& byte : bytes) byte = static_cast<unsigned char>(random());
    expectDamaged(bytes, std::to_string(size) + " random bytes");
  }
  EXPECT_THROW(Checkpoint(folder_.path("missing")), ImageError);
  EXPECT_THROW(Checkpoint(folder_.folder().string()), ImageError);
  EXPECT_THROW(readCheckpointHeader(folder_.path("missing")), ImageError);
  EXPECT_THROW(readCheckpointHeader(folder_.folder().string()), ImageError);
  EXPECT_THROW(readCheckpointHeader("/dev/zero"), ImageError);
}

// Whether the folder's file system has files without names.
bool hasUnnamedFiles(const std::filesystem::path& folder) {
  const int file = ::open(folder.c_str(), O_WRONLY | O_TMPFILE | O_CLOEXEC, 0666);
  if (file >= 0) ::close(file);
  return file >= 0;
}

// Whoever is killed or fails while writing leaves the file as it was. A temporary one is beside it only where it needs
// a name.
TEST_F(CheckpointTest, anUnfinishedWriteLeavesTheLastFile) {
  const std::string file = fileOf(settingsOf(Method::pt));
  const Bytes before = readFileBytes(file);
  const auto filesInFolder = [&] {
    const std::filesystem::directory_iterator files(folder_.folder());
    return std::distance(begin(files), end(files));
  };
  {
    AtomicFile unfinished(file);
    unfinished.write(before);
    unfinished.write(before);
    EXPECT_EQ(filesInFolder(), hasUnnamedFiles(folder_.folder()) ? 1 : 2);
  }
  EXPECT_EQ(filesInFolder(), 1);
  EXPECT_EQ(readFileBytes(file), before);
  folder_.write("file.tmp.1234.0", "left by one that was killed");
  folder_.write("other.tmp.1234.0", "of another file");
  folder_.write("file.tmp.xml", "no temporary one");
  removeTemporaries(file);
  EXPECT_EQ(filesInFolder(), 3);
  EXPECT_EQ(readFileBytes(file), before);
}

}  // namespace
}  // namespace wavecrest
