// Ten thousand damaged files (tests/load/fuzz_cases.h), loaded and compiled for the kernels in this process: each ends
// well or in a LoadError or SceneError, within its time and memory. Meant for the asan-ubsan preset, where any misuse
// of memory and any undefined behaviour ends the process.
#include <sys/resource.h>

#include <ctime>

#include "engine/compile/compiled_scene.h"
#include "engine/scene/scene_error.h"
#include "tests/load/fuzz_cases.h"

// One allocation beyond the bound ends the process; what is freed is given back soon, so that the process's size means
// something.
// NOLINTNEXTLINE(readability-identifier-naming,bugprone-reserved-identifier)
extern "C" const char* __asan_default_options();
// NOLINTNEXTLINE(readability-identifier-naming,bugprone-reserved-identifier)
extern "C" const char* __asan_default_options() { return "max_allocation_size_mb=1024:quarantine_size_mb=16"; }

namespace wavecrest {
namespace {

struct Outcome {
  int rendered = 0, loaded = 0, refused = 0;  // loaded: but refused by the compilation
};

void runCase(int index, const Folder& folder, Outcome& outcome) {
  SCOPED_TRACE("WAVECREST_FUZZ_CASE=" + std::to_string(index));
  const std::filesystem::path path = writeCase(folder, index);
  const std::clock_t start = std::clock();  // of CPU time, which other programs do not lengthen
  try {
    const Scene scene = loadScene(path, {.lenient = isLenient(index)});
    ++outcome.loaded;
    compileScene<float>(scene, Accel::automatic);
    --outcome.loaded;
    ++outcome.rendered;
  } catch (const LoadError& error) {
    EXPECT_FALSE(error.text.empty());
    ++outcome.refused;
  } catch (const SceneError& error) {
    EXPECT_NE(std::string(error.what()).find("; expected"), std::string::npos) << error.what();
  } catch (const std::exception& error) {
    ADD_FAILURE() << "neither a LoadError nor a SceneError: " << error.what();
  }
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  EXPECT_LT(seconds, kSecondsPerCase);
}

size_t mostMemory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<size_t>(usage.ru_maxrss) * 1024;
}

TEST(Fuzz, DamagedFilesLoadOrAreRefused) {
  const Folder folder;
  writeSeeds(folder);
  const auto [first, last] = casesToRun();
  Outcome outcome;
  for (int i = first; i < last && !HasFailure(); ++i) runCase(i, folder, outcome);
  EXPECT_LT(mostMemory(), kMostMemory);
  RecordProperty("cases", last - first);
  RecordProperty("whole", outcome.rendered);
  RecordProperty("loaded_only", outcome.loaded);
  RecordProperty("refused", outcome.refused);
  RecordProperty("most_memory_mb", static_cast<int>(mostMemory() >> 20));
  if (last - first < kFewCases) return;
  // Both happen, or the mutations would be too weak or too strong to test anything.
  EXPECT_GT(outcome.rendered, (last - first) / 10);
  EXPECT_GT(outcome.refused, (last - first) / 4);
}

TEST(Fuzz, TheUndamagedFilesLoad) {
  const Folder folder;
  writeSeeds(folder);
  for (const std::string& ply : {std::string(kQuadPly), binaryQuadPly(false), binaryQuadPly(true), gzip(kUvPlySeed)}) {
    folder.write("mesh.ply", ply);
    const Scene scene = load(folder, kSceneSeed);
    EXPECT_EQ(scene.shapes.size(), 9u);
    EXPECT_NO_THROW(compileScene<float>(scene, Accel::automatic));
  }
  EXPECT_EQ(load(folder, kSkySeed).emitters.size(), 1u);
  EXPECT_EQ(load(folder, kSunskySeed).emitters.size(), 1u);
  folder.write("mesh.ply", kQuadPly);
  const Scene materials = load(folder, kMaterialSeed);
  EXPECT_EQ(materials.shapes.size(), 7u);
  EXPECT_EQ(materials.instances.size(), 2u);
  EXPECT_NO_THROW(compileScene<float>(materials, Accel::automatic));
  const Scene colors = load(folder, kColorSeed);
  EXPECT_EQ(colors.shapes.size(), 1u);
  EXPECT_NO_THROW(compileScene<float>(colors, Accel::automatic));
}

}  // namespace
}  // namespace wavecrest
