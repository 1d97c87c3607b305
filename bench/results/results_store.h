// The writer of a results file. Each put is one transaction: a process that dies between two leaves a file with all of
// the one and nothing of the other, which a later campaign continues.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bench/results/database.h"
#include "wavecrest/results.h"

namespace wavecrest {

class ResultsStore {
 public:
  // Opens a results file, or makes a new one. Throws ResultsFileError.
  explicit ResultsStore(const std::filesystem::path& path);
  // Leaves one file without a journal beside it, which can be copied and read in a folder that is read-only.
  ~ResultsStore();
  ResultsStore(const ResultsStore&) = delete;
  ResultsStore& operator=(const ResultsStore&) = delete;

  // Settings and environment; a key that is already there gets the new value.
  void putCampaign(const std::map<std::string, std::string>& values);
  // Values that earlier processes put under the same keys stay, before the new ones: "old, new".
  void addEnvironment(const std::map<std::string, std::string>& values);
  // Replaces what was known of this scene, but for its runs.
  void putScene(const SceneRecord& scene);
  // Throws ResultsFileError if the run is there already: nothing is ever counted twice.
  void putRun(const RunRecord& run);
  // The same of a run that is there, of less time: takes its place, in one transaction.
  void replaceRun(const RunRecord& run);
  // Replaces rows of the same scene, method and snapshot.
  void putBiases(const std::vector<BiasRecord>& biases);
  // Replaces all claims.
  void putClaims(const std::vector<ClaimRecord>& claims);

  // The hash under which a scene was put; nothing if it was not.
  std::optional<std::string> sceneHash(const std::string& scene);
  // What is stored of a run; nothing if it is not there.
  struct KnownRun {
    RunState state;
    std::string stats;
    std::vector<std::string> images;  // of the snapshots that have one
  };
  std::optional<KnownRun> findRun(const std::string& scene, const std::string& method, uint64_t seed);

 private:
  Database database_;
};

}  // namespace wavecrest
