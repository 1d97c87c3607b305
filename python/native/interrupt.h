// Ctrl-C while C++ works: the work is asked to stop, and Python learns of the signal afterwards.
#pragma once

#include <atomic>

namespace wavecrest::python {

// While it lives, SIGINT calls stop(what) from the signal's handler and then whatever handler Python has. Only in the
// main thread, where Python's handlers run, and not where SIGINT is ignored. Hold the GIL to make and to destroy one;
// the work in between may release it. Scopes may be nested, as when the callback of a campaign renders: the signal then
// stops the work of all of them.
class InterruptScope {
 public:
  InterruptScope(void (*stop)(void*), void* what);
  ~InterruptScope();
  InterruptScope(const InterruptScope&) = delete;
  InterruptScope& operator=(const InterruptScope&) = delete;

  // Whether Ctrl-C came: then its KeyboardInterrupt has been taken, for the caller to raise with what there is. Another
  // exception of a signal handler is thrown as it is.
  bool interrupted();

 private:
  static void onInterrupt(int signal);

  void (*stop_)(void*);
  void* what_;
  InterruptScope* outer_ = nullptr;
  std::atomic<bool> requested_{false};
  bool active_ = false, installed_ = false;  // installed: the handler, by this scope
};

}  // namespace wavecrest::python
