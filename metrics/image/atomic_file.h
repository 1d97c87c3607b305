// Whole files in and out. Writing is atomic: a reader sees the old content or the new, never a part, also after a
// crash.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace wavecrest {

// The file's bytes. Throws ImageError when it is missing, unreadable or not a regular file.
std::vector<unsigned char> readFileBytes(const std::string& path);

// A file that is replaced as a whole. write() fills a temporary file in the same folder, without a name where the file
// system has such files; commit() flushes it to the device and renames it over the target. Whoever is destroyed without
// commit() leaves the target as it was. If the target is a symbolic link, the file that it points to is replaced.
// Devices and pipes are written to directly. Every member throws ImageError where it fails.
class AtomicFile {
 public:
  explicit AtomicFile(const std::string& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  void write(std::span<const unsigned char> bytes);
  // False for devices and pipes, which take bytes in order only.
  bool isSeekable() const { return !temporary_.empty(); }
  // Where the next write goes, from the beginning.
  void seek(uint64_t position);
  void commit();

 private:
  std::string path_, target_;
  std::string temporary_;  // empty: committed, or written to as it is
  bool named_ = false;     // the temporary file has its name
  int descriptor_ = -1;
};

// All of a file at once.
void writeFileAtomically(const std::string& path, std::span<const unsigned char> bytes);
void writeFileAtomically(const std::string& path, std::string_view text);

// Throws ImageError where writeFileAtomically would: a folder that does not exist or takes no new files, or a target
// that is a folder. Lets a program fail before long work instead of after it.
void checkWritable(const std::string& path);

// Removes the temporary files that writers of this path have left because they were killed. Nobody may be writing it.
void removeTemporaries(const std::string& path);
// The same for all files of a folder; what is in folders within it stays.
void removeTemporariesIn(const std::string& folder);

}  // namespace wavecrest
