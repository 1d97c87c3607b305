// Whole files in and out. Writing is atomic: a reader sees the old content or the new, never a part, also after a
// crash.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace wavecrest {

// The file's bytes. Throws ImageError when it is missing, unreadable or not a regular file.
std::vector<unsigned char> readFileBytes(const std::string& path);

// Writes to a temporary name in the same folder; commit() flushes it to the device and renames it over the target. A
// symbolic link stays, and what it points to is replaced; devices and pipes are written to as they are. Without
// commit() the target stays as it was. All throw ImageError where they fail.
class AtomicFile {
 public:
  explicit AtomicFile(const std::string& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  void write(std::span<const unsigned char> bytes);
  void commit();

 private:
  std::string path_, target_;
  std::string temporary_;  // empty: committed, or written to as it is
  int descriptor_ = -1;
};

// All of a file at once.
void writeFileAtomically(const std::string& path, std::span<const unsigned char> bytes);

// Throws ImageError where writeFileAtomically would: a folder that does not exist or takes no new files, or a target
// that is a folder. Lets a program fail before long work instead of after it.
void checkWritable(const std::string& path);

// Removes the temporary files that writers of this path have left because they were killed. Nobody may be writing it.
void removeTemporaries(const std::string& path);

}  // namespace wavecrest
