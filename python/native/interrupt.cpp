#include "interrupt.h"

#include <csignal>

#include <thread>

#include "native.h"

namespace wavecrest::python {
namespace {

std::atomic<InterruptScope*> innermost{nullptr};
std::atomic<int> handling{0};  // handlers at work; the signal may come to any thread
struct sigaction previous {};  // Python's, while ours is installed

bool inMainThread() {
  const nb::module_ threading = nb::module_::import_("threading");
  return threading.attr("current_thread")().is(threading.attr("main_thread")());
}

}  // namespace

void InterruptScope::onInterrupt(int signal) {
  handling.fetch_add(1);
  for (InterruptScope* scope = innermost.load(); scope != nullptr; scope = scope->outer_) {
    scope->requested_.store(true);
    scope->stop_(scope->what_);
  }
  previous.sa_handler(signal);  // Python's, which notes the signal for its interpreter
  handling.fetch_sub(1);
}

InterruptScope::InterruptScope(void (*stop)(void*), void* what) : stop_(stop), what_(what), outer_(innermost.load()) {
  if (!inMainThread()) return;
  struct sigaction now {};
  sigaction(SIGINT, nullptr, &now);
  const bool plain = (now.sa_flags & SA_SIGINFO) == 0;
  if (!plain || now.sa_handler == SIG_IGN || now.sa_handler == SIG_DFL) return;
  innermost.store(this);
  active_ = true;
  if (now.sa_handler == onInterrupt) return;  // an outer scope has installed it
  previous = now;
  now.sa_handler = onInterrupt;
  installed_ = sigaction(SIGINT, &now, nullptr) == 0;
}

InterruptScope::~InterruptScope() {
  if (!active_) return;
  innermost.store(outer_);
  // A handler that a callback has set in the meantime stays.
  struct sigaction now {};
  sigaction(SIGINT, nullptr, &now);
  if (installed_ && now.sa_handler == onInterrupt) sigaction(SIGINT, &previous, nullptr);
  // A handler that runs in another thread may still have this scope.
  while (handling.load() != 0) std::this_thread::yield();
}

bool InterruptScope::interrupted() {
  if (!active_ || !requested_.load()) return false;
  if (PyErr_CheckSignals() == 0) return true;
  if (PyErr_ExceptionMatches(PyExc_KeyboardInterrupt) == 0) throw nb::python_error();
  PyErr_Clear();
  return true;
}

}  // namespace wavecrest::python
