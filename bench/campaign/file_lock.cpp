#include "bench/campaign/file_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace wavecrest {
namespace {

std::string thisProcess() {
  std::array<char, 256> host{};
  if (gethostname(host.data(), host.size() - 1) != 0) host[0] = '\0';
  return fmt::format("process {} on {}", getpid(), host[0] == '\0' ? "this machine" : host.data());
}

std::string readHolder(int descriptor) {
  std::array<char, 320> text{};
  const ssize_t count = pread(descriptor, text.data(), text.size() - 1, 0);
  return count > 0 ? std::string(text.data()) : "another process";
}

// Whether the name still stands for the file that was opened: its holder may have removed it in between.
bool isCurrent(int descriptor, const std::filesystem::path& path) {
  struct stat opened {
  }, named{};
  return fstat(descriptor, &opened) == 0 && stat(path.c_str(), &named) == 0 && opened.st_ino == named.st_ino &&
         opened.st_dev == named.st_dev;
}

}  // namespace

FileLock::FileLock(const std::filesystem::path& file) : path_(file.string() + ".lock") {
  for (;;) {
    descriptor_ = open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor_ < 0) {
      throw FileLockError(
          fmt::format("{}: cannot be made: {}; expected a writable folder", path_.string(), std::strerror(errno)));
    }
    if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      const std::string holder = readHolder(descriptor_);
      close(descriptor_);
      throw FileLockError(fmt::format("{}: {} works on it; expected one at a time", file.string(), holder));
    }
    if (isCurrent(descriptor_, path_)) break;
    close(descriptor_);
  }
  const std::string text = thisProcess();
  if (ftruncate(descriptor_, 0) != 0 || pwrite(descriptor_, text.data(), text.size(), 0) < 0) {
    return;  // it is locked, and only does not say by whom
  }
}

FileLock::~FileLock() {
  unlink(path_.c_str());  // before others can take it
  close(descriptor_);
}

}  // namespace wavecrest
