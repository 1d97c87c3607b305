#include "bench/against/program_copy.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/sendfile.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "bench/against/child_render.h"

namespace wavecrest {

ProgramCopy::ProgramCopy(std::filesystem::path program) : program_(std::move(program)), path_(program_) {}

ProgramCopy::~ProgramCopy() { close(); }

void ProgramCopy::close() {
  if (file_ >= 0) ::close(file_);
  file_ = -1;
}

void ProgramCopy::renew() {
  if (inPlace_) return;
  const auto fail = [&] { throw ChildError(fmt::format("{}: {}", program_.string(), std::strerror(errno))); };
  const int from = open(program_.c_str(), O_RDONLY | O_CLOEXEC);
  if (from < 0) fail();
  // The copy before goes last, or its pages would be taken again at once.
  const int to = memfd_create("wavecrest", MFD_CLOEXEC);
  struct stat about {};
  bool copied = to >= 0 && fstat(from, &about) == 0;
  for (off_t left = about.st_size; copied && left > 0;) {
    const ssize_t sent = sendfile(to, from, nullptr, static_cast<size_t>(left));
    copied = sent > 0;
    left -= sent;
  }
  ::close(from);
  if (!copied) {
    if (to >= 0) ::close(to);
    fail();
  }
  close();
  file_ = to;
  path_ = fmt::format("/proc/{}/fd/{}", getpid(), file_);
}

void ProgramCopy::stayInPlace() {
  close();
  inPlace_ = true;
  path_ = program_;
}

}  // namespace wavecrest
