#include "bench/against/stop_signals.h"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <iterator>
#include <mutex>

namespace wavecrest {
namespace {

constexpr int kStopSignals[] = {SIGINT, SIGTERM, SIGHUP};
constexpr int kExitStopped = 130;

std::atomic<bool> stopCame{false};
std::mutex stopMutex;
int stopGuards = 0;  // alive
struct sigaction stopsBefore[std::size(kStopSignals)]{};

void noteStop(int) {
  if (stopCame.exchange(true)) _exit(kExitStopped);
}

}  // namespace

StopSignals::StopSignals() {
  const std::lock_guard<std::mutex> lock(stopMutex);
  if (stopGuards++ != 0) return;
  stopCame.store(false);
  for (size_t i = 0; i < std::size(kStopSignals); ++i) {
    sigaction(kStopSignals[i], nullptr, &stopsBefore[i]);
    if (stopsBefore[i].sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_handler = noteStop;
    sigemptyset(&action.sa_mask);
    sigaction(kStopSignals[i], &action, nullptr);
  }
}

StopSignals::~StopSignals() {
  const std::lock_guard<std::mutex> lock(stopMutex);
  if (--stopGuards != 0) return;
  for (size_t i = 0; i < std::size(kStopSignals); ++i) sigaction(kStopSignals[i], &stopsBefore[i], nullptr);
}

bool StopSignals::came() { return stopCame.load(); }

}  // namespace wavecrest
