#include "cli/interrupt.h"

#include <csignal>

namespace wavecrest {
namespace {

std::atomic<Session*> watched{nullptr};
std::atomic<bool> requested{false};

void onInterrupt(int) {
  if (requested.exchange(true)) std::signal(SIGINT, SIG_DFL);
  if (Session* const session = watched.load()) session->interrupt();
}

}  // namespace

InterruptGuard::InterruptGuard() {
  requested.store(false);
  previous_ = std::signal(SIGINT, onInterrupt);
}

InterruptGuard::~InterruptGuard() {
  std::signal(SIGINT, previous_);
  watched.store(nullptr);
}

void InterruptGuard::watch(Session* session) {
  watched.store(session);
  if (session != nullptr && requested.load()) session->interrupt();
}

bool InterruptGuard::interrupted() const { return requested.load(); }

}  // namespace wavecrest
