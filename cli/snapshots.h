// When snapshots are due, and where they are written.
#pragma once

#include <optional>
#include <string>

namespace wavecrest {

class SnapshotSchedule {
 public:
  // "" for none, "log" for render times that grow by a fixed ratio, else a duration between snapshots.
  explicit SnapshotSchedule(const std::string& text);

  // Render time of the next snapshot, in seconds; nothing if there are none.
  std::optional<double> next() const;
  void advance() { ++index_; }
  unsigned index() const { return index_; }  // of the next snapshot, from 0

 private:
  enum class Kind { none, regular, logarithmic } kind_ = Kind::none;
  double interval_ = 0;
  unsigned index_ = 0;
};

// NAME.0007.exr beside the output NAME.exr.
std::string snapshotPath(const std::string& output, unsigned index);

}  // namespace wavecrest
