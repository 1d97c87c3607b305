#include "cli/interrupt.h"

#include <unistd.h>

#include <atomic>
#include <ctime>
#include <iterator>
#include <thread>

#include "library/errors.h"

namespace wavecrest {
namespace {

// State that the handlers share with the guard; handlers may use only what is lock-free. watched: the session that
// renders, or null. endsAtOnce: the guard is idle.
std::atomic<Session*> watched{nullptr};
std::atomic<bool> endsAtOnce{false}, saveWanted{false}, pauseWanted{false}, attentionWanted{false}, toldToStop{false};
std::atomic<int64_t> firstRequest{0};  // milliseconds on the monotonic clock; 0: none yet
static_assert(std::atomic<Session*>::is_always_lock_free && std::atomic<int64_t>::is_always_lock_free);
// Set before the handlers are installed. Handlers only read it.
std::string endLine;

// A signal comes to any thread, so a handler may run beside the thread that renders. It is counted while it holds the
// watched session, or is about to end an idle program: whoever ends the session or the idleness waits for it. A handler
// that interrupts the waiting thread itself is through before that goes on.
std::atomic<int> visits{0};
struct Visit {
  Visit() { visits.fetch_add(1); }
  ~Visit() { visits.fetch_sub(1); }
  Visit(const Visit&) = delete;
  Visit& operator=(const Visit&) = delete;
};

// No handler acts by what it has seen before.
void waitForVisits() {
  while (visits.load() != 0) std::this_thread::yield();
}

// A signal that comes more than this after the first request ends the program at once. What comes sooner is the same
// request, as a terminal, a shell and a scheduler may all send theirs.
constexpr int64_t kImpatience = 250;  // milliseconds

// Time on the monotonic clock; never 0, which means that there was no request.
int64_t milliseconds() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return int64_t{now.tv_sec} * 1000 + now.tv_nsec / 1'000'000 + 1;
}

void interruptWatched() {
  if (Session* const session = watched.load()) session->interrupt();
}

void onStop(int signal) {
  const Visit visit;
  // Idle: nothing can be lost.
  if (endsAtOnce.load()) {
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, endLine.data(), endLine.size());
    _exit(kExitInterrupted);
  }
  // The first request is noted, before the session is looked for: one that is watched from then on finds the request.
  // Where there was one before, `none` then holds its time.
  int64_t none = 0;
  const int64_t now = milliseconds();
  if (!firstRequest.compare_exchange_strong(none, now) && signal != SIGXCPU && now - none > kImpatience) {
    _exit(kExitInterrupted);
  }
  // Otherwise the session returns once the waves under way are done.
  interruptWatched();
}

// Whether the session is to return: to end, to be saved or to pause.
bool isWanted() {
  return firstRequest.load() != 0 || toldToStop.load() || saveWanted.load() || pauseWanted.load() ||
         attentionWanted.load();
}

// Stores the reason before the interrupt, because the thread that renders looks for the reason once the session
// returns.
void pauseFor(std::atomic<bool>& reason) {
  const Visit visit;
  reason.store(true);
  interruptWatched();
}

void onSave(int) { pauseFor(saveWanted); }

}  // namespace

InterruptGuard::InterruptGuard(const std::string& lineAtEnd) {
  endLine = lineAtEnd.empty() ? "" : lineAtEnd + "\n";
  firstRequest.store(0);
  saveWanted.store(false);
  pauseWanted.store(false);
  attentionWanted.store(false);
  toldToStop.store(false);
  endsAtOnce.store(true);
  for (size_t i = 0; i < std::size(kSignals); ++i) {
    // Under nohup SIGHUP is ignored. That stays so.
    sigaction(kSignals[i], nullptr, &previous_[i]);
    if (kSignals[i] == SIGHUP && previous_[i].sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_handler = kSignals[i] == SIGUSR1 ? onSave : onStop;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(kSignals[i], &action, nullptr);
  }
}

InterruptGuard::~InterruptGuard() {
  for (size_t i = 0; i < std::size(kSignals); ++i) sigaction(kSignals[i], &previous_[i], nullptr);
  watch(nullptr);
}

void InterruptGuard::setIdle(bool value) {
  endsAtOnce.store(value);
  waitForVisits();
}

void InterruptGuard::watch(Session* session) {
  endsAtOnce.store(false);
  watched.store(session);
  waitForVisits();
  if (session != nullptr && isWanted()) session->interrupt();
}

bool InterruptGuard::interrupted() const { return signalled() || toldToStop.load(); }
bool InterruptGuard::signalled() const { return firstRequest.load() != 0; }
void InterruptGuard::stop() { pauseFor(toldToStop); }
bool InterruptGuard::takeSaveRequest() { return saveWanted.exchange(false); }
void InterruptGuard::requestPause() { pauseFor(pauseWanted); }
bool InterruptGuard::takePauseRequest() { return pauseWanted.exchange(false); }
void InterruptGuard::requestAttention() { pauseFor(attentionWanted); }
bool InterruptGuard::takeAttentionRequest() { return attentionWanted.exchange(false); }

void InterruptGuard::goOn() {
  Session* const session = watched.load();
  if (session == nullptr) return;
  // resume() also erases the interrupt of a request that has just come, so that interrupt is repeated.
  session->resume();
  if (isWanted()) session->interrupt();
}

}  // namespace wavecrest
