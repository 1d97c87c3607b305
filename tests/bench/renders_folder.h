// A folder of renders of an imagined scene, with images whose errors are known in advance.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "bench/report/collect_renders.h"
#include "bench/report/results_folder.h"
#include "metrics/image/image_io.h"
#include "tests/metrics/temporary_folder.h"

namespace wavecrest::test {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr uint32_t kRenderSide = 16;

// All pixels 0.5, every second one brighter and the others darker by the deviation: RMSE against 0.5 is the deviation.
inline Image speckled(float deviation, uint32_t side = kRenderSide) {
  Image image{.width = side, .height = side, .channels = 3, .pixels = {}};
  for (uint32_t i = 0; i < side * side; ++i) {
    for (int c = 0; c < 3; ++c) image.pixels.push_back(0.5F + (i % 2 == 0 ? deviation : -deviation));
  }
  return image;
}

// A whole reference, as `wavecrest reference` writes it.
inline void writeWhole(const fs::path& file, const Image& mean) {
  const Metadata says{
      {"wavecrest:scene_hash", "00ff"}, {"wavecrest:relative_error", "0.25"}, {"wavecrest:noise_floor.rmse", "0.125"}};
  const std::array<ExrLayer, 1> layers{ExrLayer{"difference", speckled(0.1F, mean.width)}};
  writeExr(file.string(), mean, says, layers);
}

class CollectRenders : public testing::Test {
 protected:
  void SetUp() override { writeWhole(folder / "box.reference.exr", speckled(0)); }

  // A run of two snapshots, of error 0.2 and 0.1, and no final image.
  json addRun(const std::string& stem, const json& changes = json::object()) {
    writeExr((folder / (stem + ".000.exr")).string(), speckled(0.2F));
    writeExr((folder / (stem + ".001.exr")).string(), speckled(0.1F));
    json stats = {
        {"scene", "some/where/box.xml"},
        {"method", "pt"},
        {"seed", 1},
        {"sampler", "independent"},
        {"precision", "float"},
        {"iterations", 40},
        {"render_seconds", 4.0},
        {"cpu_seconds", 8.0},
        {"paths_per_second", 100.0},
        {"isa", "avx2"},
        {"stages", {{{"name", "extend"}, {"items", 10}, {"seconds", 1.5}}}},
        {"snapshots",
         {{{"index", 0}, {"render_seconds", 1.0}, {"iterations", 10}, {"file", stem + ".000.exr"}},
          {{"index", 1}, {"render_seconds", 4.0}, {"iterations", 40}, {"file", "gone/" + stem + ".001.exr"}}}}};
    stats.update(changes);
    std::ofstream(folder / (stem + ".json")) << stats;
    return stats;
  }

  // A run without snapshots.
  void addFinal(const std::string& stem, uint64_t seed, double seconds, uint64_t iterations) {
    addRun(stem,
           {{"seed", seed}, {"render_seconds", seconds}, {"iterations", iterations}, {"snapshots", json::array()}});
    for (const char* snapshot : {".000.exr", ".001.exr"}) fs::remove(folder / (stem + snapshot));
    writeExr((folder / (stem + ".exr")).string(), speckled(0.1F));
  }

  // The text of the error that collecting ends in.
  std::string error() const {
    try {
      collectRenders(folder);
    } catch (const ResultsError& failure) {
      return failure.what();
    } catch (const ImageError& failure) {
      return failure.what();
    }
    return "none";
  }

  const TemporaryFolder temporary;
  const fs::path folder = temporary.folder();
};

}  // namespace wavecrest::test
