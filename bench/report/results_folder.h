// What a results folder holds: for each run the --stats file and its snapshots, and for each scene a reference.
//
// Runs are all `*.json` files with the keys of `render --stats`, except those of references. The reference of a scene
// is `SCENE.reference.exr`, or two independent halves of equal effort `SCENE.reference.1.exr` and `.2.exr`, whose mean
// is the reference and whose difference is its noise. SCENE is the stem of the name that the runs give. `reference.exr`
// is that of a scene without one of its own.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace wavecrest {

/// A folder that no report can be made of. The text is complete: "FILE: what is wrong; what was expected".
struct ResultsError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct SnapshotFile {
  unsigned number = 0;  ///< as the stats say; 0 of other images
  double seconds = 0;   ///< render clock
  uint64_t iterations = 0;
  std::filesystem::path image;
};

struct RunFile {
  std::filesystem::path path;  ///< of the stats file
  std::string scene, method;
  std::string sceneHash;  ///< empty if the stats do not say
  uint64_t seed = 0;
  nlohmann::json stats;  ///< everything it says
  std::vector<SnapshotFile>
      snapshots;       ///< in order of time, at least one; the last is the final image if that is there
  bool other = false;  ///< an image by name or list (other_images.h): without stats, perhaps of another program
};

/// All runs with stats files of a folder in the order of their file names. Throws ResultsError if it is no folder, or
/// one is malformed or names a snapshot that does not exist.
std::vector<RunFile> readRuns(const std::filesystem::path& folder);

/// One or two files that are the reference of a scene. Throws ResultsError if there is none.
std::vector<std::filesystem::path> findReference(const std::filesystem::path& folder, const std::string& scene);

/// Whether a file has the name of a reference of any scene.
bool isReferenceFile(const std::filesystem::path& file);

/// The scene of images that do not say theirs: SCENE of the only SCENE.reference.exr, else the folder's name.
std::string sceneOfFolder(const std::filesystem::path& folder);

}  // namespace wavecrest
