#include "metrics/image/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "metrics/image/image.h"

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

// Unique among the processes and threads that may write beside each other.
std::string temporaryName(const std::string& path) {
  static std::atomic<unsigned> counter{0};
  return path + kTemporary + "." + std::to_string(::getpid()) + "." + std::to_string(counter++);
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

// What a chain of symbolic links ends at, or the path itself.
std::string targetOf(const std::string& path) {
  std::error_code error;
  if (!fs::is_symlink(path, error)) return path;
  const fs::path target = fs::canonical(path, error);
  return error ? path : target.string();
}

// Devices and pipes, which a new file must not take the place of.
bool isSpecial(const std::string& target) {
  struct stat info {};
  return ::stat(target.c_str(), &info) == 0 && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode);
}

// Where the system names the files of this process, if it does.
constexpr const char* kDescriptors = "/proc/self/fd/";

// A descriptor of a new file without a name in the folder of `temporary`, which vanishes with this process; -1 where
// the file system has no such files.
int createUnnamed(const std::string& temporary) {
  if (::access(kDescriptors, X_OK) != 0) return -1;
  const fs::path folder = fs::path(temporary).parent_path();
  return ::open(folder.empty() ? "." : folder.c_str(), O_WRONLY | O_TMPFILE | O_CLOEXEC, 0666);
}

// A descriptor of a new file. An existing file of that name is an error. path is for the message.
int createTemporary(const std::string& path, const std::string& temporary) {
  const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0) failWriting(path, "creating the file", errno);
  return file;
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

// The file is read up to the size that it has when it is opened.
std::vector<unsigned char> readFileBytes(const std::string& path) {
  // Without O_NONBLOCK opening a pipe would wait for a writer. It makes no difference for regular files.
  Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.get() < 0) failReading(path, errno);
  struct stat info {};
  if (::fstat(file.get(), &info) != 0) failReading(path, errno);
  if (!S_ISREG(info.st_mode)) throw ImageError(path, "is not a regular file", "expected a file");
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
  const std::string temporary = temporaryName(target);
  const Descriptor file(createTemporary(path, temporary));
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
  const std::string temporary = temporaryName(target_);
  descriptor_ = createUnnamed(temporary);
  named_ = descriptor_ < 0;
  if (named_) descriptor_ = createTemporary(path, temporary);
  temporary_ = temporary;
}

AtomicFile::~AtomicFile() {
  ::close(descriptor_);
  if (named_) ::unlink(temporary_.c_str());
}

void AtomicFile::write(std::span<const unsigned char> bytes) {
  if (!writeAll(descriptor_, bytes)) failWriting(path_, "writing", errno);
}

void AtomicFile::seek(uint64_t position) {
  if (::lseek(descriptor_, static_cast<off_t>(position), SEEK_SET) < 0) failWriting(path_, "seeking", errno);
}

void AtomicFile::commit() {
  // The bytes reach the device before the name does, so a crash in between leaves the old file.
  if (temporary_.empty()) return;
  if (::fsync(descriptor_) != 0) failWriting(path_, "flushing", errno);
  if (!named_) {
    const std::string unnamed = kDescriptors + std::to_string(descriptor_);
    if (::linkat(AT_FDCWD, unnamed.c_str(), AT_FDCWD, temporary_.c_str(), AT_SYMLINK_FOLLOW) != 0) {
      failWriting(path_, "naming the file", errno);
    }
    named_ = true;
  }
  if (std::rename(temporary_.c_str(), target_.c_str()) != 0) failWriting(path_, "renaming", errno);
  named_ = false;
  temporary_.clear();
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
  const fs::path target = fs::absolute(targetOf(path));
  const std::string own = target.filename().string();
  removeFiles(target.parent_path(), [&](const std::string& name) { return targetOfTemporary(name) == own; });
}

void removeTemporariesIn(const std::string& folder) {
  removeFiles(folder, [](const std::string& name) { return !targetOfTemporary(name).empty(); });
}

}  // namespace wavecrest
