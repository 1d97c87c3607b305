#include "cli/checkpointing.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

#include "cli/commands.h"
#include "cli/file_check.h"
#include "library/option_values.h"
#include "metrics/image/atomic_file.h"

namespace wavecrest {
namespace {

constexpr const char* kDefaultInterval = "1m";

constexpr double kLongestInterval = 1e9;  // seconds; the system's clocks overflow not much later

}  // namespace

void addCheckpointOptions(const Command& command, CheckpointOptions& options) {
  command.add("--checkpoint", options.file, "file that keeps the render's state, to go on from with --resume");
  command.add("--checkpoint-every", options.every,
              fmt::format("save it after this much time; default: {}", kDefaultInterval));
  command.addFlag("--resume", options.resume, "go on from --checkpoint, or begin where there is none yet");
}

Checkpointing::Checkpointing(const CheckpointOptions& options)
    : seconds_(std::min(parseDuration("--checkpoint-every", options.every.empty() ? kDefaultInterval : options.every),
                        kLongestInterval)) {
  if (options.file.empty()) {
    if (!options.resume && options.every.empty()) return;
    throw UsageError(fmt::format("{}: there is no checkpoint; expected --checkpoint FILE",
                                 options.resume ? "--resume" : "--checkpoint-every"));
  }
  if (options.file == kStandardStream) throw UsageError("--checkpoint -: expected a file");
  lock_.emplace(options.file);
  // Whether there is one does not change from here on.
  const bool exists = std::filesystem::exists(options.file);
  if (exists && !options.resume) {
    throw UsageError(
        fmt::format("{} exists; expected --resume to go on with it, or another --checkpoint", options.file));
  }
  removeTemporaries(options.file);
  if (exists) earlier_ = std::make_unique<Checkpoint>(options.file);
}

CheckpointTimer::CheckpointTimer(InterruptGuard& guard, double seconds) {
  thread_ = std::thread([this, &guard, seconds] {
    std::unique_lock<std::mutex> lock(mutex_);
    while (!changed_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return over_; })) {
      guard.requestPause();
    }
  });
}

CheckpointTimer::~CheckpointTimer() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    over_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

}  // namespace wavecrest
