#include "cli/messages.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>

namespace wavecrest {
namespace {

int firstStdoutError = 0;

void noteStdout(bool written) {
  if (!written && firstStdoutError == 0) firstStdoutError = errno;
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

int flushStdout() {
  noteStdout(std::fflush(stdout) == 0);
  return firstStdoutError;
}

}  // namespace wavecrest
