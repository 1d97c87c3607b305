// What `bench --score` measures against: the hash of every image for each instruction set, with the build that rendered
// it, and the speed of the reference machine. Committed as JSON beside this file and compiled in.
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>

#include "bench/score/build_name.h"
#include "bench/score/workload.h"

namespace wavecrest {

// A file of hashes that cannot be used. The text says why, without the file's name.
struct ScoreFileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// 64 bits that two different images hardly share: FNV-1a over the bits of all samples.
uint64_t hashImage(std::span<const float> samples);

// The name under which this build's images are filed: the instruction set, and "-general" where only the general
// kernels were compiled, which round differently.
std::string hashGroup(Isa isa);

class ImageHashes {
 public:
  // Throws ScoreFileError.
  static ImageHashes parse(const nlohmann::json& file);
  static ImageHashes committed();  // bench/score/image_hashes.json
  nlohmann::ordered_json toJson() const;

  std::optional<uint64_t> find(ScoreSize size, const std::string& group, const ScoreEntry& entry) const;
  void set(ScoreSize size, const std::string& group, const ScoreEntry& entry, uint64_t hash);

  // buildName() of the build that rendered the images of a size and group; empty where that is not known.
  const std::string& buildOf(ScoreSize size, const std::string& group) const;
  void setBuild(ScoreSize size, const std::string& group, const std::string& build);

 private:
  std::map<std::string, uint64_t> hashes_;     // by SIZE/GROUP/SCENE/METHOD
  std::map<std::string, std::string> builds_;  // by SIZE/GROUP
};

// Paths per CPU second of one thread of the reference machine, 256x192 pixels.
struct ReferenceMachine {
  std::string name;
  std::map<std::string, double> rates;  // by SCENE/METHOD
  double rateOf(const ScoreEntry& entry) const;
};
const ReferenceMachine& referenceMachine();  // bench/score/reference_machine.json

}  // namespace wavecrest
