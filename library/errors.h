// Exit codes, and the errors of whoever asks: wrong options, and files that cannot be used.
#pragma once

#include <stdexcept>

namespace wavecrest {

enum ExitCode : int {
  kExitDone = 0,
  kExitFailure = 1,       // a fault of ours
  kExitUsage = 2,         // wrong options
  kExitInput = 3,         // a scene, image or checkpoint that cannot be used
  kExitCheck = 4,         // a check that was asked for did not hold
  kExitInterrupted = 130  // after saving
};

struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace wavecrest
