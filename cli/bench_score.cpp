// wavecrest bench --score: the score of this machine; with --write-hashes and --write-pictures what validates scores.
#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/against/child_render.h"
#include "bench/score/score.h"
#include "cli/bench_modes.h"
#include "cli/commands.h"
#include "cli/messages.h"
#include "engine/load/load.h"
#include "library/option_values.h"
#include "metrics/image/atomic_file.h"
#include "scenes/scene_list.h"

namespace wavecrest {
namespace {

// The hashes or pictures in a file that --write-hashes or --write-pictures made.
template <class Expected>
Expected readExpected(const std::string& file) {
  const nlohmann::json json = readJsonFile(file);
  try {
    return Expected::parse(json);
  } catch (const ScoreFileError& error) {
    throw InputError(fmt::format("{}: {}", file, error.what()));
  }
}

// The workload, or the part of it that has the named methods and scenes. A scene that is not in it is a UsageError.
std::vector<ScoreEntry> chosenEntries(const BenchOptions& options, ScoreSize size) {
  std::vector<ScoreEntry> entries = workloadOf(size);
  const std::vector<Method> methods = parseMethodList(options.methods);
  const auto contains = [](const auto& list, const auto& value) {
    return std::find(list.begin(), list.end(), value) != list.end();
  };
  for (const std::string& scene : options.scenes) {
    const bool known =
        std::any_of(entries.begin(), entries.end(), [&](const ScoreEntry& entry) { return entry.scene == scene; });
    if (known) continue;
    throw UsageError(
        fmt::format("--score {}: has no scene {}; expected none, or some of its own", options.score, scene));
  }
  for (const Method method : options.methods.empty() ? std::vector<Method>() : methods) {
    const bool known =
        std::any_of(entries.begin(), entries.end(), [&](const ScoreEntry& entry) { return entry.method == method; });
    if (known) continue;
    throw UsageError(
        fmt::format("--score {}: has no method {}; expected none, or some of pt, lt, bpt, mlt, ppm, bpm, vcm",
                    options.score, toString(method)));
  }
  std::erase_if(entries, [&](const ScoreEntry& entry) {
    return !contains(methods, entry.method) || (!options.scenes.empty() && !contains(options.scenes, entry.scene));
  });
  return entries;
}

// Reads a file that is to be extended; empty if there is none yet.
template <class Expected>
Expected earlier(const std::string& file) {
  return std::filesystem::exists(file) ? readExpected<Expected>(file) : Expected();
}

// Renders the image that validates each entry, on all instruction sets of this machine but scalar, and stores its hash
// for each, and its picture for the first, in the files. What they hold of other sizes and instruction sets stays.
int writeExpected(const BenchOptions& options, ScoreSize size, uint32_t threads) {
  const std::string &hashFile = options.writeHashes, &pictureFile = options.writePictures;
  ImageHashes hashes = earlier<ImageHashes>(hashFile);
  ExpectedPictures pictures = earlier<ExpectedPictures>(pictureFile);
  std::vector<Isa> isas = availableIsas();
  std::erase(isas, Isa::scalar);
  // Pictures alone need one instruction set: the narrowest, which most machines have.
  if (hashFile.empty()) isas.resize(1);
  for (const ScoreEntry& entry : chosenEntries(options, size)) {
    const Scene scene = loadScene(findScene(entry.scene), {.filmSize = std::array{entry.width, entry.height}});
    for (const Isa isa : isas) {
      const Image image = validatedImage(scene, entry, isa, threads);
      hashes.set(size, hashGroup(isa), entry, hashImage(image.pixels));
      hashes.setBuild(size, hashGroup(isa), buildName());
      if (isa == isas.front()) pictures.set(size, entry, pictureOf(image));
    }
    tell("{} {} {}", options.score, entry.scene, toString(entry.method));
  }
  if (!hashFile.empty()) writeFileAtomically(hashFile, hashes.toJson().dump(1) + "\n");
  if (!pictureFile.empty()) writeFileAtomically(pictureFile, pictures.toJson().dump(1) + "\n");
  return kExitDone;
}

}  // namespace

int runBenchScore(const BenchOptions& options) {
  // Checks options; --write-hashes and --write-pictures replace the measurement.
  if (!options.size.empty() || !options.duration.empty()) {
    throw UsageError("--score has sizes and lengths of its own; expected neither --size nor --duration");
  }
  const auto size = static_cast<ScoreSize>(parseChoice("--score", options.score, kScoreSizeNames));
  const uint32_t threads = benchThreads(options);
  if (!options.writeHashes.empty() || !options.writePictures.empty()) return writeExpected(options, size, threads);
  // The request: a workload, this machine, and where its scenes and references are.
  const ScoreRequest request{.size = size,
                             .entries = chosenEntries(options, size),
                             .isa = bestIsa(),
                             .threads = threads,
                             .sceneFile = findScene,
                             .references = sceneFolder() / "references"};
  requireScratchFolders();
  printBench(options, scoreHeading(request));
  // Measures. Each row is printed once it is measured.
  ExpectedImages expected = ExpectedImages::committed();
  if (!options.hashes.empty()) expected.hashes = readExpected<ImageHashes>(options.hashes);
  if (!options.pictures.empty()) expected.pictures = readExpected<ExpectedPictures>(options.pictures);
  const ScoreResult result =
      measureScore(request, expected, [&](const ScoreRow& row) { printBench(options, toText(row)); });
  printBench(options, toText(result));
  writeBenchJson(options, "score", toJson(result));
  return result.allAccepted() ? kExitDone : kExitCheck;
}

}  // namespace wavecrest
