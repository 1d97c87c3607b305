// Ctrl-C as a wish to stop: while a guard lives, it asks the session that renders to return instead of ending the
// program; a second one ends it.
#pragma once

#include <atomic>

#include "engine/session.h"

namespace wavecrest {

class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  // The session that is to stop, or null while none renders. One that comes after Ctrl-C is stopped at once.
  void watch(Session* session);
  bool interrupted() const;

 private:
  void (*previous_)(int);
};

}  // namespace wavecrest
