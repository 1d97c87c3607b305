// A program to be timed, wherever in memory its file happens to lie.
//
// The pages of a program's file keep their places in physical memory from run to run, and with them which of its code
// and tables share sets of the caches: two copies of one file differed by up to 6 % in speed, in all runs alike, which
// no number of runs averages out. So runs are of fresh copies, and where a program lies becomes chance.
#pragma once

#include <filesystem>

namespace wavecrest {

class ProgramCopy {
 public:
  // A file that can be run. Throws ChildError if it cannot be read.
  explicit ProgramCopy(std::filesystem::path program);
  ~ProgramCopy();
  ProgramCopy(const ProgramCopy&) = delete;
  ProgramCopy& operator=(const ProgramCopy&) = delete;

  // What is to be run: the latest copy, or the program where it stands, which is so at first.
  const std::filesystem::path& path() const { return path_; }
  // Copies the program anew. Throws ChildError if there is no memory for it.
  void renew();
  // From now on path() is the program itself, for programs that do not run from a copy, such as those that look for
  // libraries beside them.
  void stayInPlace();
  bool inPlace() const { return inPlace_; }

 private:
  void close();

  const std::filesystem::path program_;
  std::filesystem::path path_;
  int file_ = -1;  // in memory, without a name
  bool inPlace_ = false;
};

}  // namespace wavecrest
