// What the owner of a campaign or reference is told of its sessions, so that a signal can stop or pause them. Each may
// be empty.
#pragma once

#include <functional>

namespace wavecrest {

class Session;

struct SessionHooks {
  std::function<void(Session*)> watch = {};  // the session about to render; null: none
  std::function<bool()> goesOn = {};         // after an interrupt: whether the session goes on, resumed
  std::function<void(bool)> idle = {};       // true: nothing is half done, the process may end at any moment
};

// Idle for its lifetime: while a scene is loaded or built.
class IdleScope {
 public:
  explicit IdleScope(const SessionHooks& hooks) : hooks_(hooks) {
    if (hooks_.idle) hooks_.idle(true);
  }
  ~IdleScope() {
    if (hooks_.idle) hooks_.idle(false);
  }
  IdleScope(const IdleScope&) = delete;
  IdleScope& operator=(const IdleScope&) = delete;

 private:
  const SessionHooks& hooks_;
};

// Tells of a session for its lifetime, also where an exception ends it.
class WatchScope {
 public:
  WatchScope(const SessionHooks& hooks, Session& session) : hooks_(hooks) {
    if (hooks_.watch) hooks_.watch(&session);
  }
  ~WatchScope() {
    if (hooks_.watch) hooks_.watch(nullptr);
  }
  WatchScope(const WatchScope&) = delete;
  WatchScope& operator=(const WatchScope&) = delete;

 private:
  const SessionHooks& hooks_;
};

}  // namespace wavecrest
