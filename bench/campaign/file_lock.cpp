#include "bench/campaign/file_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "metrics/image/real_name.h"

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
  return fstat(descriptor, &opened) == 0 && lstat(path.c_str(), &named) == 0 && opened.st_ino == named.st_ino &&
         opened.st_dev == named.st_dev;
}

// An empty or former lock, opened. Throws FileLockError.
int openLock(const std::filesystem::path& path) {
  const int descriptor = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666);
  struct stat info {};
  if (descriptor < 0 && errno != ELOOP) {
    throw FileLockError(
        fmt::format("{}: cannot be made: {}; expected a writable folder", path.string(), std::strerror(errno)));
  }
  if (descriptor >= 0 && fstat(descriptor, &info) == 0 && S_ISREG(info.st_mode) && info.st_nlink <= 1) {
    return descriptor;
  }
  if (descriptor >= 0) close(descriptor);
  throw FileLockError(fmt::format("{}: is a link or no plain file; expected the lock of a wavecrest", path.string()));
}

}  // namespace

FileLock::FileLock(const std::filesystem::path& file) : path_(realName(file).string() + ".lock") {
  for (;;) {
    descriptor_ = openLock(path_);
    if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      const std::string holder = readHolder(descriptor_);
      close(descriptor_);
      throw FileIsLocked(fmt::format("{}: {} works on it; expected one at a time", file.string(), holder));
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
