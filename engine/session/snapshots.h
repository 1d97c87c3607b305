// Snapshots of a render: when they are due, and the loop that renders from one to the next.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "engine/session/session.h"

namespace wavecrest {

class SnapshotSchedule {
 public:
  static SnapshotSchedule none() { return SnapshotSchedule(Kind::none); }
  static SnapshotSchedule every(double seconds);                                  // of render time
  static SnapshotSchedule logarithmic() { return SnapshotSchedule(Kind::time); }  // render times of a fixed ratio
  // At render times of a fixed ratio until they are further apart than this, then at its multiples.
  static SnapshotSchedule logarithmicThenEvery(double seconds) {
    return SnapshotSchedule(Kind::timeThenRegular, seconds);
  }
  static SnapshotSchedule doubling() { return SnapshotSchedule(Kind::doubling); }  // after 1, 2, 4, ... iterations

  // What the snapshot of this number, from 0 on, waits for: render seconds, or iterations, or neither if there is none.
  struct Due {
    std::optional<double> seconds;
    std::optional<uint64_t> iterations;
  };
  Due due(unsigned number) const;
  // The number of the first snapshot that is due after so much of a render.
  unsigned firstAfter(double seconds, uint64_t iterations) const;
  // Another one for each other schedule, to tell them apart.
  std::string text() const;

 private:
  enum class Kind { none, regular, time, timeThenRegular, doubling };
  explicit SnapshotSchedule(Kind kind, double interval = 0) : kind_(kind), interval_(interval) {}

  Kind kind_;
  double interval_;
};

// Renders to the iterations or the time of the settings, whichever comes first, or to an interrupt. On the way calls
// onSnapshot with the number of each snapshot once it is due; the clock stands still meanwhile. Whether there is a
// whole image by then, onSnapshot has to ask (RenderStatistics::hasWholeImage). After an interrupt it goes on if
// goesOn, which has to call resume(), returns true. first: the number of the first snapshot; where a session was
// restored, earlier ones have been taken. Returns how many snapshots there were, with those before the first.
unsigned renderWithSnapshots(Session& session, const RenderSettings& settings, const SnapshotSchedule& schedule,
                             const std::function<void(unsigned number)>& onSnapshot,
                             const std::function<bool()>& goesOn = {}, unsigned first = 0);

}  // namespace wavecrest
