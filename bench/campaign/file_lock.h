// A lock on a file that one process at a time may work on: a campaign's results, a reference.
//
// It is a file of its own beside it, NAME.lock, held by flock: the kernel lets go of it however the process ends, so a
// lock never has to be removed by hand. It says who holds it. File systems that know no locks are taken to be free.
//
// Whatever links lead to a file, its lock is beside the real one. What lies in the place of the lock and is no plain
// file of a single name is refused: others may have put it there to have another file overwritten.
#pragma once

#include <filesystem>
#include <stdexcept>

namespace wavecrest {

// The file cannot be locked. The text is complete.
struct FileLockError : std::runtime_error {
  using std::runtime_error::runtime_error;
};
// Another process works on it.
struct FileIsLocked : FileLockError {
  using FileLockError::FileLockError;
};

class FileLock {
 public:
  // Throws FileIsLocked where another process holds it, else FileLockError. The folder must exist.
  explicit FileLock(const std::filesystem::path& file);
  // Removes the lock's file.
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
};

}  // namespace wavecrest
