// Renders with a wavecrest binary, this one or an older build, in a process of its own.
#pragma once

#include <filesystem>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/against/stop_signals.h"

namespace wavecrest {

// The child could not be started, or failed. The text is complete: "BINARY: what it said".
struct ChildError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// A folder for what children write, deleted with everything in it, also after a stop signal.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  const StopSignals signals_;
  std::filesystem::path path_;
};

// Throws if no scratch folder can be created. To be called before measuring with child processes, which need one.
inline void requireScratchFolders() { const ScratchFolder probe; }

// What a render is asked for, in options that every version of wavecrest has. Variables that are defaults of options,
// such as WAVECREST_SAMPLER, are not passed on to it.
struct ChildRequest {
  std::filesystem::path scene;
  std::string method;
  std::string size;  // WIDTHxHEIGHT, or empty for the scene's own
  uint64_t iterations = 1, seed = 0;
  uint32_t threads = 1;
  std::vector<std::string> more;         // further options
  std::optional<std::string> imageFile;  // where the image goes, if anywhere
};

// Runs `BINARY render` to its end and returns its --stats. patience: seconds after which it is ended. Throws
// ChildError, and ChildStopped after a stop signal.
nlohmann::json renderInChild(const std::filesystem::path& binary, const ChildRequest& request,
                             const ScratchFolder& folder, double patience = std::numeric_limits<double>::infinity());

// Paths per second of as many processes of this program that render the same at the same time, on one thread each, with
// seeds from 0 on: their sum.
double rateOfProcesses(uint32_t count, const ChildRequest& request);

// The file that this process runs.
std::filesystem::path ownBinary();

}  // namespace wavecrest
