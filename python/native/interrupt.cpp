#include "interrupt.h"

#include <csignal>

#include <atomic>

#include "native.h"

namespace wavecrest::python {
namespace {

std::atomic<void (*)(void*)> stopWork{nullptr};
std::atomic<void*> work{nullptr};
std::atomic<bool> requested{false};
struct sigaction previous {};

void onInterrupt(int signal) {
  requested.store(true);
  if (void (*const stop)(void*) = stopWork.load()) stop(work.load());
  previous.sa_handler(signal);  // Python's, which notes the signal for its interpreter
}

bool inMainThread() {
  const nb::module_ threading = nb::module_::import_("threading");
  return threading.attr("current_thread")().is(threading.attr("main_thread")());
}

}  // namespace

InterruptScope::InterruptScope(void (*stop)(void*), void* what) {
  if (!inMainThread()) return;
  sigaction(SIGINT, nullptr, &previous);
  const bool plain = (previous.sa_flags & SA_SIGINFO) == 0;
  if (!plain || previous.sa_handler == SIG_IGN || previous.sa_handler == SIG_DFL) return;
  requested.store(false);
  work.store(what);
  stopWork.store(stop);
  struct sigaction ours = previous;
  ours.sa_handler = onInterrupt;
  installed_ = sigaction(SIGINT, &ours, nullptr) == 0;
}

InterruptScope::~InterruptScope() {
  if (!installed_) return;
  sigaction(SIGINT, &previous, nullptr);
  stopWork.store(nullptr);
}

bool InterruptScope::interrupted() {
  if (!installed_ || !requested.load()) return false;
  if (PyErr_CheckSignals() == 0) return true;
  if (PyErr_ExceptionMatches(PyExc_KeyboardInterrupt) == 0) throw nb::python_error();
  PyErr_Clear();
  return true;
}

}  // namespace wavecrest::python
