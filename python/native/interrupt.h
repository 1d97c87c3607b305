// Ctrl-C while C++ works: the work is asked to stop, and Python learns of the signal afterwards.
#pragma once

namespace wavecrest::python {

// While it lives, SIGINT calls stop(what) from the signal's handler and then whatever handler Python has. Only in the
// main thread, where Python's handlers run, and not where SIGINT is ignored. One at a time. To be made and destroyed
// with the GIL; in between the work may run without.
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
  bool installed_ = false;
};

}  // namespace wavecrest::python
