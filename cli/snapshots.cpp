#include "cli/snapshots.h"

#include <fmt/core.h>

#include <cmath>
#include <filesystem>

#include "cli/option_values.h"

namespace wavecrest {
namespace {

// Six snapshots per decade from a tenth of a second on: evenly spaced on the report's logarithmic axis.
constexpr double kFirstLogSnapshot = 0.1;
constexpr double kSnapshotsPerDecade = 6;

}  // namespace

SnapshotSchedule::SnapshotSchedule(const std::string& text) {
  if (text.empty()) return;
  if (text == "log") {
    kind_ = Kind::logarithmic;
  } else {
    kind_ = Kind::regular;
    interval_ = parseDuration(text);
  }
}

std::optional<double> SnapshotSchedule::next() const {
  switch (kind_) {
    case Kind::none:
      return std::nullopt;
    case Kind::regular:
      return interval_ * (index_ + 1);
    case Kind::logarithmic:
      return kFirstLogSnapshot * std::pow(10.0, index_ / kSnapshotsPerDecade);
  }
  return std::nullopt;
}

std::string snapshotPath(const std::string& output, unsigned index) {
  const std::filesystem::path path(output);
  return (path.parent_path() / fmt::format("{}.{:04}.exr", path.stem().string(), index)).string();
}

}  // namespace wavecrest
