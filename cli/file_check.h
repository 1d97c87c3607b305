// The files that a command reads and writes, checked before its work begins: what cannot be written, and what would
// overwrite an input or another output, is a UsageError.
#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace wavecrest {

// As the name of a file: stdin or stdout.
constexpr const char* kStandardStream = "-";

class FileCheck {
 public:
  // role: the option that names the file, for messages. Several inputs may be one file.
  void input(const std::string& role, const std::filesystem::path& file);
  // The folder must exist and be writable; the file may exist and is then replaced.
  void output(const std::string& role, const std::filesystem::path& file);
  // An output whose format, that of its name's ending, must be one that images are written in.
  void image(const std::string& role, const std::filesystem::path& file);
  // An output that keeps the halves of a reference, in layers that only EXR has.
  void reference(const std::string& role, const std::filesystem::path& file);
  // A file that is to be written, among others of its kind, in a folder that has been checked.
  void laterOutput(const std::string& role, const std::filesystem::path& file);

 private:
  struct Use {
    std::string role;
    bool written = false;
  };
  void add(const Use& use, const std::filesystem::path& file);

  std::map<std::filesystem::path, Use> uses_;
};

// Replaces the file, or writes to stdout. Throws ImageError where that fails, but not where the reader of stdout has
// enough.
void writeText(const std::string& file, const std::string& text);

}  // namespace wavecrest
