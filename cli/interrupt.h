// Signals as wishes. While a guard lives, SIGINT, SIGTERM, SIGHUP and SIGXCPU ask the session that renders to return,
// so that what there is can be saved; SIGUSR1 asks it to pause for a save. SIGPIPE never ends the program (main.cpp).
//
// The first signal that comes while files are written changes nothing: what was to be saved is saved. Several of them
// within a quarter of a second count as one, as a terminal, a shell and a scheduler may all send theirs. A later one
// ends the program at once, with kExitInterrupted, whatever it does; but not SIGXCPU, which the system repeats each
// second from a soft limit of CPU time to the hard one.
#pragma once

#include <csignal>
#include <iterator>
#include <string>

#include "engine/session/session.h"

namespace wavecrest {

class InterruptGuard {
 public:
  // A guard begins idle: see setIdle.
  explicit InterruptGuard(const std::string& lineAtEnd);
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  // Idle: nothing is half done, as while a scene is loaded or built. A signal then ends the program at once with
  // lineAtEnd, if there is one, on stderr and kExitInterrupted.
  void setIdle(bool idle);
  // The session that is to stop, or null while none renders. One that comes after a signal is stopped at once. The
  // program is no longer idle. Once it returns nobody holds the former session, which may end.
  void watch(Session* session);
  // By a signal, or by stop().
  bool interrupted() const;
  // By a signal to this process.
  bool signalled() const;
  // Does what a first signal does, from any thread: another process of the same render has got one. A signal that comes
  // here later is then the first.
  void stop();
  // Whether SIGUSR1 has come since the last call.
  bool takeSaveRequest();
  // Asks the watched session to pause, from any thread; and whether that was asked since the last call.
  void requestPause();
  bool takePauseRequest();
  // The same for whoever has something to do between two waves.
  void requestAttention();
  bool takeAttentionRequest();
  // The watched session may go on, unless it is to end, to be saved or to pause again.
  void goOn();

 private:
  static constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP, SIGXCPU, SIGUSR1};
  struct sigaction previous_[std::size(kSignals)]{};
};

// Watches a session for its lifetime, also where an exception ends it.
class SessionWatch {
 public:
  SessionWatch(InterruptGuard& guard, Session& session) : guard_(guard) { guard_.watch(&session); }
  ~SessionWatch() { guard_.watch(nullptr); }
  SessionWatch(const SessionWatch&) = delete;
  SessionWatch& operator=(const SessionWatch&) = delete;

 private:
  InterruptGuard& guard_;
};

}  // namespace wavecrest
