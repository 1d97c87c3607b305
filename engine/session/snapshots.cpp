#include "engine/session/snapshots.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace wavecrest {
namespace {

// Six snapshots per decade from a tenth of a second on: evenly spaced on the report's logarithmic axis.
constexpr double kFirstLogSnapshot = 0.1;
constexpr double kSnapshotsPerDecade = 6;

double logarithmicTime(unsigned number) { return kFirstLogSnapshot * std::pow(10.0, number / kSnapshotsPerDecade); }

}  // namespace

SnapshotSchedule SnapshotSchedule::every(double seconds) { return SnapshotSchedule(Kind::regular, seconds); }

SnapshotSchedule::Due SnapshotSchedule::due(unsigned number) const {
  switch (kind_) {
    case Kind::none:
      return {};
    case Kind::regular:
      return {.seconds = interval_ * (number + 1.0), .iterations = std::nullopt};
    case Kind::time:
      return {.seconds = logarithmicTime(number), .iterations = std::nullopt};
    case Kind::timeThenRegular: {
      unsigned last = 0;  // at a time of a fixed ratio
      while (logarithmicTime(last + 1) - logarithmicTime(last) <= interval_) ++last;
      if (number <= last) return {.seconds = logarithmicTime(number), .iterations = std::nullopt};
      // The number of multiples of the interval up to the last snapshot of a fixed ratio.
      const double before = std::floor(logarithmicTime(last) / interval_);
      return {.seconds = interval_ * (before + number - last), .iterations = std::nullopt};
    }
    case Kind::doubling:
      // Bounded, because a shift by 64 or more is undefined.
      return {.seconds = std::nullopt, .iterations = uint64_t{1} << std::min(number, 63u)};
  }
  return {};
}

unsigned SnapshotSchedule::firstAfter(double seconds, uint64_t iterations) const {
  unsigned number = 0;
  const auto isPast = [&](const Due& due) {
    return (due.seconds && *due.seconds <= seconds) || (due.iterations && *due.iterations <= iterations);
  };
  while (isPast(due(number))) ++number;
  return number;
}

std::string SnapshotSchedule::text() const {
  constexpr std::array kNames{"none", "regular", "log", "log then regular", "doubling"};  // by Kind
  return fmt::format("{} {:g}", kNames[static_cast<size_t>(kind_)], interval_);
}

unsigned renderWithSnapshots(Session& session, const RenderSettings& settings, const SnapshotSchedule& schedule,
                             const std::function<void(unsigned number)>& onSnapshot,
                             const std::function<bool()>& goesOn, unsigned first) {
  for (unsigned number = first;; ++number) {
    const SnapshotSchedule::Due due = schedule.due(number);
    // The limits of the render may end it before this snapshot is due.
    const bool inTime = due.seconds && (!settings.seconds || *due.seconds <= *settings.seconds);
    const bool inIterations = due.iterations && (!settings.iterations || *due.iterations <= *settings.iterations);
    // Render to the snapshot or to the end. After an interrupt the caller decides whether to go on.
    for (;;) {
      session.renderUntil(earlier(settings.iterations, due.iterations), earlier(settings.seconds, due.seconds));
      if (!session.interrupted()) break;
      if (!goesOn || !goesOn()) return number;
    }
    // A session that has iterations left and yet ends before its time has no time for another step (chains): what it
    // has is what there will be.
    const auto hasIterations = [&](const std::optional<uint64_t>& count) {
      return count && session.statistics().iterations >= *count;
    };
    const bool reached =
        (inTime && (session.progressSeconds() >= *due.seconds || !hasIterations(settings.iterations))) ||
        (inIterations && hasIterations(due.iterations));
    if (!reached) return number;  // an interrupt that comes after the render has returned is the next call's
    onSnapshot(number);
  }
}

}  // namespace wavecrest
