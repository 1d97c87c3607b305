// Whole files in and out. Writing is atomic: a reader sees the old content or the new, never a part, also after a
// crash.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace wavecrest {

// A file that is read from its beginning. Throws ImageError where it is missing, cannot be read, or is no regular file:
// opening a pipe could wait forever, and a device may have no end.
class FileReader {
 public:
  explicit FileReader(const std::string& path);
  ~FileReader();
  FileReader(const FileReader&) = delete;
  FileReader& operator=(const FileReader&) = delete;
  uint64_t size() const { return size_; }  // when it was opened
  // The next bytes: at most `most`, fewer where the file ends.
  std::vector<unsigned char> read(uint64_t most);

 private:
  std::string path_;
  int descriptor_ = -1;
  uint64_t size_ = 0, position_ = 0;
};

// All bytes of a file. Throws as FileReader does.
std::vector<unsigned char> readFileBytes(const std::string& path);

// A file that is replaced as a whole. write() fills a temporary file in the same folder, without a name where the file
// system has such files; commit() flushes it to the device and renames it over the target. Whoever is destroyed without
// commit() leaves the target as it was. If the target is a symbolic link, the file that it points to is replaced, or
// made where there is none yet. Devices and pipes are written to directly. Every member throws ImageError where it
// fails.
class AtomicFile {
 public:
  explicit AtomicFile(const std::string& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  void write(std::span<const unsigned char> bytes);
  // False for devices and pipes, which take bytes in order only.
  bool isSeekable() const { return replaces_; }
  // Where the next write goes, from the beginning.
  void seek(uint64_t position);
  void commit();

 private:
  std::string path_, target_;
  bool replaces_ = false;  // the target is still to be replaced; not where it is written to as it is
  std::string temporary_;  // the name of the temporary file, while it has one
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
