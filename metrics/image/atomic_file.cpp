#include "metrics/image/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

#include "metrics/image/image.h"
#include "metrics/image/real_name.h"

namespace wavecrest {
namespace {

namespace fs = std::filesystem;

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
  int release() { return std::exchange(fd_, -1); }

 private:
  int fd_;
};

[[noreturn]] void failReading(const std::string& path, int error) {
  throw ImageError(path, std::string("cannot be read: ") + std::strerror(error), "expected a readable file");
}

// step names what failed: "writing", "renaming".
[[noreturn]] void failWriting(const std::string& path, const char* step, int error) {
  throw ImageError(path, std::string(step) + " failed: " + std::strerror(error), "expected a writable place");
}

// Comes after the target's name in every temporary name, before the numbers of the process and of the file.
constexpr const char* kTemporary = ".tmp";

// Unique among all calls in all threads and processes of this machine.
std::string temporaryName(const std::string& path) {
  static std::atomic<unsigned> counter{0};
  return path + kTemporary + "." + std::to_string(::getpid()) + "." + std::to_string(counter++);
}

// The first of the target's temporary names that make(name) does not find taken; empty, with errno, where it fails. A
// killed process with the number of this one may have left files of such names: in a container, numbers begin at 1.
template <class Make>
std::string makeTemporary(const std::string& target, Make make) {
  constexpr int kMostTries = 1000;
  for (int i = 0; i < kMostTries; ++i) {
    std::string name = temporaryName(target);
    if (make(name)) return name;
    if (errno != EEXIST) break;
  }
  return "";
}

// The target's name, of a name that temporaryName() may have given; empty for any other.
std::string targetOfTemporary(fs::path name) {
  for (int numbers = 0; numbers < 2; ++numbers) {
    const std::string number = name.extension().string();
    if (number.size() < 2 || number.find_first_not_of("0123456789", 1) != std::string::npos) return "";
    name.replace_extension();
  }
  return name.extension() == kTemporary ? name.stem().string() : "";
}

// Devices and pipes, which a new file must not take the place of.
bool isSpecial(const std::string& target) {
  struct stat info {};
  return ::stat(target.c_str(), &info) == 0 && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode);
}

// What a chain of symbolic links ends at, or the path itself.
std::string targetOf(const std::string& path) {
  std::error_code error;
  if (!fs::is_symlink(path, error)) return path;
  const fs::path target = realName(path, error);
  if (!error) return target.string();
  // The pipe behind /dev/stdout has no name of its own.
  if (isSpecial(path)) return path;
  throw ImageError(path, "is a link that leads to no file: " + error.message(), "expected one that does");
}

// Where the system names the files of this process, if it does.
constexpr const char* kDescriptors = "/proc/self/fd/";

// A descriptor of a new file without a name in the folder of the target, which vanishes with this process; -1 where
// the file system has no such files.
int createUnnamed(const std::string& target) {
  if (::access(kDescriptors, X_OK) != 0) return -1;
  const fs::path folder = fs::path(target).parent_path();
  return ::open(folder.empty() ? "." : folder.c_str(), O_WRONLY | O_TMPFILE | O_CLOEXEC, 0666);
}

// A new file with a temporary name of the target, which is returned, and its descriptor. path is for the message.
std::string createTemporary(const std::string& path, const std::string& target, int& descriptor) {
  std::string name = makeTemporary(target, [&](const std::string& free) {
    descriptor = ::open(free.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    return descriptor >= 0;
  });
  if (name.empty()) failWriting(path, "creating the file", errno);
  return name;
}

// False, with errno, where not all of it could be written.
bool writeAll(int file, std::span<const unsigned char> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(file, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return false;
    bytes = bytes.subspan(static_cast<size_t>(count));
  }
  return true;
}

// Removes those files of a folder whose names chooses(name) accepts. What cannot be read or removed is left.
template <class Chooses>
void removeFiles(const fs::path& folder, Chooses chooses) {
  std::error_code ignored;
  for (fs::directory_iterator file(folder, ignored), end; file != end; file.increment(ignored)) {
    if (ignored) return;
    if (chooses(file->path().filename().string())) ::unlink(file->path().c_str());
  }
}

}  // namespace

FileReader::FileReader(const std::string& path) : path_(path) {
  // Without O_NONBLOCK opening a pipe would wait for a writer. It makes no difference for regular files.
  Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.get() < 0) failReading(path, errno);
  struct stat info {};
  if (::fstat(file.get(), &info) != 0) failReading(path, errno);
  if (!S_ISREG(info.st_mode)) throw ImageError(path, "is not a regular file", "expected a file");
  size_ = static_cast<uint64_t>(info.st_size);
  descriptor_ = file.release();
}

FileReader::~FileReader() { ::close(descriptor_); }

// Not beyond the size that the file had when it was opened, by which the bytes are allocated.
std::vector<unsigned char> FileReader::read(uint64_t most) {
  std::vector<unsigned char> bytes(static_cast<size_t>(std::min(most, size_ - position_)));
  size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count = ::read(descriptor_, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) failReading(path_, errno);
    if (count == 0) break;  // shrunk while being read
    done += static_cast<size_t>(count);
  }
  bytes.resize(done);
  position_ += done;
  return bytes;
}

std::vector<unsigned char> readFileBytes(const std::string& path) {
  FileReader file(path);
  return file.read(file.size());
}

void checkWritable(const std::string& path) {
  const std::string target = targetOf(path);
  // The folder must exist, and the target must not be a folder.
  const fs::path folder = fs::path(target).parent_path();
  std::error_code ignored;
  if (!folder.empty() && !fs::is_directory(folder, ignored)) {
    throw ImageError(path, "there is no folder '" + folder.string() + "'", "expected one that exists");
  }
  if (fs::is_directory(target, ignored)) throw ImageError(path, "is a folder", "expected a file name");
  // Devices and pipes must be writable themselves.
  if (isSpecial(target)) {
    if (::access(target.c_str(), W_OK) != 0) failWriting(path, "opening", errno);
    return;
  }
  // Whether the folder takes new files shows only when one is made.
  int descriptor = -1;
  const std::string temporary = createTemporary(path, target, descriptor);
  const Descriptor file(descriptor);
  ::unlink(temporary.c_str());
}

AtomicFile::AtomicFile(const std::string& path) : path_(path), target_(targetOf(path)) {
  // A device or pipe has no temporary file.
  if (isSpecial(target_)) {
    descriptor_ = ::open(target_.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor_ < 0) failWriting(path, "opening", errno);
    return;
  }
  // A file without a name leaves nothing behind if the process is killed.
  replaces_ = true;
  descriptor_ = createUnnamed(target_);
  if (descriptor_ < 0) temporary_ = createTemporary(path, target_, descriptor_);
}

AtomicFile::~AtomicFile() {
  ::close(descriptor_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::write(std::span<const unsigned char> bytes) {
  if (!writeAll(descriptor_, bytes)) failWriting(path_, "writing", errno);
}

void AtomicFile::seek(uint64_t position) {
  if (::lseek(descriptor_, static_cast<off_t>(position), SEEK_SET) < 0) failWriting(path_, "seeking", errno);
}

void AtomicFile::commit() {
  // The bytes reach the device before the name does, so a crash in between leaves the old file.
  if (!replaces_) return;
  if (::fsync(descriptor_) != 0) failWriting(path_, "flushing", errno);
  if (temporary_.empty()) {
    const std::string unnamed = kDescriptors + std::to_string(descriptor_);
    temporary_ = makeTemporary(target_, [&](const std::string& free) {
      return ::linkat(AT_FDCWD, unnamed.c_str(), AT_FDCWD, free.c_str(), AT_SYMLINK_FOLLOW) == 0;
    });
    if (temporary_.empty()) failWriting(path_, "naming the file", errno);
  }
  if (std::rename(temporary_.c_str(), target_.c_str()) != 0) failWriting(path_, "renaming", errno);
  temporary_.clear();
  replaces_ = false;
}

void writeFileAtomically(const std::string& path, std::span<const unsigned char> bytes) {
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

void writeFileAtomically(const std::string& path, std::string_view text) {
  writeFileAtomically(path, std::span(reinterpret_cast<const unsigned char*>(text.data()), text.size()));
}

void removeTemporaries(const std::string& path) {
  // The folder of a bare file name is the current one, which only the absolute path names.
  const fs::path target = realName(path);
  const std::string own = target.filename().string();
  removeFiles(target.parent_path(), [&](const std::string& name) { return targetOfTemporary(name) == own; });
}

void removeTemporariesIn(const std::string& folder) {
  removeFiles(folder, [](const std::string& name) { return !targetOfTemporary(name).empty(); });
}

}  // namespace wavecrest
