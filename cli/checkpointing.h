// `render --checkpoint FILE [--checkpoint-every DUR] [--resume]`: when checkpoints are due, and whether there is one to
// go on from.
//
// The file is locked while a render has it. It is replaced every now and then, after SIGUSR1 and at the end, however
// the render ends; it stays behind, so that a render can go on to more iterations or more time.
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "bench/campaign/file_lock.h"
#include "bench/checkpoint/checkpoint.h"
#include "cli/command_line.h"
#include "cli/interrupt.h"

namespace wavecrest {

struct CheckpointOptions {
  std::string file, every;
  bool resume = false;
};

void addCheckpointOptions(const Command& command, CheckpointOptions& options);

// What is to be gone on from, and the lock on the file.
class Checkpointing {
 public:
  // Throws UsageError where options do not fit together or a file would be overwritten, InputError where another
  // process works on it, CheckpointError and ImageError where it cannot be gone on from.
  explicit Checkpointing(const CheckpointOptions& options);

  // Null where the render begins from the start. May be released once the session is restored.
  std::unique_ptr<Checkpoint> takeEarlier() { return std::move(earlier_); }
  double seconds() const { return seconds_; }  // from one checkpoint to the next

 private:
  double seconds_;
  std::optional<FileLock> lock_;
  std::unique_ptr<Checkpoint> earlier_;
};

// While it lives, asks the session that a guard watches to pause each time that a checkpoint is due.
class CheckpointTimer {
 public:
  CheckpointTimer(InterruptGuard& guard, double seconds);
  ~CheckpointTimer();
  CheckpointTimer(const CheckpointTimer&) = delete;
  CheckpointTimer& operator=(const CheckpointTimer&) = delete;

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool over_ = false;
  std::thread thread_;
};

}  // namespace wavecrest
