#include "metrics/image/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "metrics/image/image.h"

namespace wavecrest {
namespace {

// A POSIX file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }

 private:
  int fd_;
};

[[noreturn]] void failReading(const std::string& path, int error) {
  throw ImageError(path, std::string("cannot be read: ") + std::strerror(error), "expected a readable image file");
}

// Unique among the processes and threads that may write beside each other.
std::string temporaryName(const std::string& path) {
  static std::atomic<unsigned> counter{0};
  return path + ".tmp." + std::to_string(::getpid()) + "." + std::to_string(counter++);
}

}  // namespace

std::vector<unsigned char> readFileBytes(const std::string& path) {
  Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.get() < 0) failReading(path, errno);
  struct stat info {};
  if (::fstat(file.get(), &info) != 0) failReading(path, errno);
  if (!S_ISREG(info.st_mode)) throw ImageError(path, "is not a regular file", "expected an image file");
  std::vector<unsigned char> bytes(static_cast<size_t>(info.st_size));
  size_t done = 0;
  while (done < bytes.size()) {
    ssize_t count = ::read(file.get(), bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) failReading(path, errno);
    if (count == 0) break;  // shrunk while being read
    done += static_cast<size_t>(count);
  }
  bytes.resize(done);
  return bytes;
}

void writeFileAtomically(const std::string& path, std::span<const unsigned char> bytes) {
  const std::string temporary = temporaryName(path);
  auto fail = [&](const char* step) {
    const int error = errno;
    ::unlink(temporary.c_str());
    throw ImageError(path, std::string(step) + " failed: " + std::strerror(error), "expected a writable place");
  };
  {
    Descriptor file(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (file.get() < 0) fail("creating the file");
    size_t done = 0;
    while (done < bytes.size()) {
      ssize_t count = ::write(file.get(), bytes.data() + done, bytes.size() - done);
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) fail("writing");
      done += static_cast<size_t>(count);
    }
    if (::fsync(file.get()) != 0) fail("flushing");
  }
  if (std::rename(temporary.c_str(), path.c_str()) != 0) fail("renaming");
}

}  // namespace wavecrest
