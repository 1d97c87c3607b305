#include "bench/report/results_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "bench/results/within_folder.h"
#include "metrics/image/real_name.h"

namespace wavecrest {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// Part of the file names of references. Their stats files are not runs.
constexpr const char* kReferenceMark = ".reference";
constexpr const char* kCommonReference = "reference.exr";

[[noreturn]] void fail(const fs::path& file, const std::string& wrong, const std::string& expected) {
  throw ResultsError(fmt::format("{}: {}; expected {}", file.string(), wrong, expected));
}

// The JSON of a stats file. Throws ResultsError if the file cannot be read or parsed.
json parseFile(const fs::path& path) {
  std::ifstream file;
  if (fs::is_regular_file(path)) file.open(path);
  if (!file.is_open()) fail(path, "cannot be read", "a stats file");
  try {
    return json::parse(file);
  } catch (const json::parse_error& error) {
    fail(path, fmt::format("is not JSON at byte {}", error.byte), "an object as written by render --stats");
  }
}

// A value of the stats. Throws ResultsError if the key is absent or has another type.
template <class Value>
Value require(const fs::path& path, const json& object, const char* key) {
  const auto entry = object.find(key);
  if (entry == object.end()) fail(path, fmt::format("has no '{}'", key), "the keys of render --stats");
  try {
    return entry->get<Value>();
  } catch (const json::exception&) {
    fail(path, fmt::format("'{}' is {}", key, entry->dump()), "the type that render --stats writes");
  }
}

// Finds the image of a snapshot. The stats name it as the renderer saw it, and the folder may have been moved since.
// Only the folder itself is searched: an absolute name may belong to the image of another render.
fs::path locate(const fs::path& stats, const std::string& name) {
  const fs::path file(name);
  for (const fs::path& candidate : {file.is_relative() ? file : file.filename(), file.filename()}) {
    fs::path beside = stats.parent_path() / candidate;
    if (isWithinFolder(stats.parent_path(), candidate) && fs::is_regular_file(beside)) return beside;
  }
  fail(stats, fmt::format("snapshot '{}' does not exist", name), "an image beside this file");
}

// The snapshots that the stats list and the final image, in order of iterations. Throws ResultsError if there is none.
std::vector<SnapshotFile> readSnapshots(const fs::path& path, const json& stats) {
  std::vector<SnapshotFile> snapshots;
  for (const json& entry : require<json>(path, stats, "snapshots")) {
    if (!entry.is_object()) fail(path, "a snapshot is " + entry.dump(), "an object");
    const auto number = static_cast<unsigned>(snapshots.size());
    snapshots.push_back({.number = entry.contains("index") ? require<unsigned>(path, entry, "index") : number,
                         .seconds = require<double>(path, entry, "render_seconds"),
                         .iterations = require<uint64_t>(path, entry, "iterations"),
                         .image = locate(path, require<std::string>(path, entry, "file"))});
  }
  std::stable_sort(snapshots.begin(), snapshots.end(),
                   [](const SnapshotFile& a, const SnapshotFile& b) { return a.iterations < b.iterations; });
  // The final image lies beside the stats under the same name; it counts if it is further than the last snapshot.
  const auto iterations = require<uint64_t>(path, stats, "iterations");
  const fs::path final = fs::path(path).replace_extension(".exr");
  if (fs::is_regular_file(final) && (snapshots.empty() || snapshots.back().iterations < iterations)) {
    snapshots.push_back({.number = snapshots.empty() ? 0 : snapshots.back().number + 1,
                         .seconds = require<double>(path, stats, "render_seconds"),
                         .iterations = iterations,
                         .image = final});
  }
  if (snapshots.empty()) fail(path, "has no snapshot and no final image", final.filename().string() + " beside it");
  return snapshots;
}

// One run from its stats file. Throws ResultsError if a key is absent or an image does not exist.
RunFile readRun(const fs::path& path) {
  RunFile run;
  run.path = path;
  run.stats = parseFile(path);
  if (!run.stats.is_object()) fail(path, "is not an object", "an object as written by render --stats");
  run.scene = fs::path(require<std::string>(path, run.stats, "scene")).stem().string();
  run.method = require<std::string>(path, run.stats, "method");
  if (run.stats.contains("scene_hash")) run.sceneHash = require<std::string>(path, run.stats, "scene_hash");
  run.seed = require<uint64_t>(path, run.stats, "seed");
  run.snapshots = readSnapshots(path, run.stats);
  return run;
}

}  // namespace

std::vector<RunFile> readRuns(const fs::path& folder) {
  if (!fs::is_directory(folder)) fail(folder, "is not a folder", "one with the results of render");
  // Collect stats files. A folder lists files in any order, so they are sorted by name.
  std::vector<fs::path> paths;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".json" && !isReferenceFile(entry.path())) {
      paths.push_back(entry.path());
    }
  }
  std::sort(paths.begin(), paths.end());
  std::vector<RunFile> runs;
  runs.reserve(paths.size());
  for (const fs::path& path : paths) runs.push_back(readRun(path));
  return runs;
}

std::vector<fs::path> findReference(const fs::path& folder, const std::string& scene) {
  // A whole reference is preferred to two halves.
  const fs::path whole = folder / (scene + kReferenceMark + ".exr");
  if (fs::is_regular_file(whole)) return {whole};
  const fs::path first = folder / (scene + kReferenceMark + ".1.exr");
  const fs::path second = folder / (scene + kReferenceMark + ".2.exr");
  if (fs::is_regular_file(first) && fs::is_regular_file(second)) return {first, second};
  if (fs::is_regular_file(folder / kCommonReference)) return {folder / kCommonReference};
  fail(folder, fmt::format("no reference for '{}'", scene),
       fmt::format("{}, {} and {}, or {}", whole.filename().string(), first.filename().string(),
                   second.filename().string(), kCommonReference));
}

bool isReferenceFile(const fs::path& file) {
  const std::string name = file.filename().string();
  return name == kCommonReference || name.find(std::string(kReferenceMark) + ".") != std::string::npos;
}

std::string sceneOfFolder(const fs::path& folder) {
  std::vector<std::string> scenes;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    const size_t mark = name.find(std::string(kReferenceMark) + ".");
    if (mark == std::string::npos || mark == 0 || entry.path().extension() != ".exr") continue;
    const std::string scene = name.substr(0, mark);
    if (std::find(scenes.begin(), scenes.end(), scene) == scenes.end()) scenes.push_back(scene);
  }
  if (scenes.size() == 1) return scenes.front();
  return realName(folder).filename().string();
}

}  // namespace wavecrest
