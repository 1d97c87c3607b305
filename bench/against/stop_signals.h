// Stop signals while child processes run.
#pragma once

#include <stdexcept>

namespace wavecrest {

// A signal has ended the work of children.
struct ChildStopped : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// While one of these lives, SIGINT, SIGTERM and SIGHUP are noted instead of ending the process, so that children can be
// ended and files removed first. A second signal ends the process. Those that are ignored stay so.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  static bool came();
};

}  // namespace wavecrest
