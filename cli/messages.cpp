#include "cli/messages.h"

#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace wavecrest {
namespace {

int firstStdoutError = 0;  // errno
bool stdoutFailureTaken = false;

void noteStdout(bool written) {
  if (!written && firstStdoutError == 0) firstStdoutError = errno;
}

// Whether stdout is a pipe whose reader has closed it, as `head` does once it has its lines.
bool readerHasLeft() {
  pollfd out{.fd = STDOUT_FILENO, .events = POLLOUT, .revents = 0};
  return poll(&out, 1, 0) == 1 && (out.revents & POLLERR) != 0;
}

}  // namespace

void writeStderr(std::string_view text) {
  while (!text.empty()) {
    const ssize_t count = ::write(STDERR_FILENO, text.data(), text.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return;
    text.remove_prefix(static_cast<size_t>(count));
  }
}

void writeStdout(std::string_view text) { noteStdout(std::fwrite(text.data(), 1, text.size(), stdout) == text.size()); }

void flushStdout() { noteStdout(std::fflush(stdout) == 0); }

std::string takeStdoutFailure() {
  flushStdout();
  if (firstStdoutError == 0 || stdoutFailureTaken || readerHasLeft()) return {};
  stdoutFailureTaken = true;
  return fmt::format("stdout: writing failed: {}; expected somebody who reads", std::strerror(firstStdoutError));
}

}  // namespace wavecrest
