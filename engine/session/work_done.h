// What a session has done, as it goes into its state (engine/state/state_stream.h).
#pragma once

#include <vector>

#include "engine/session/session.h"
#include "engine/state/state_stream.h"

namespace wavecrest {

// Counts and clocks of a session, or of all sessions before it that rendered parts of the same image.
struct WorkDone {
  uint64_t paths = 0, lightPaths = 0;
  StageCounters counters;
  double renderSeconds = 0, cpuSeconds = 0;
  std::vector<RenderStatistics::StageRow> stages;

  static WorkDone of(const RenderStatistics& statistics);
  void save(StateWriter& out) const;
  // rows: the stages of this session. Throws StateError if the state has another number of them.
  void restore(StateReader& in, std::vector<RenderStatistics::StageRow> rows);
  // For whoever has no session: stages remain without names.
  void restore(StateReader& in);
  // The work of both, of equal stages.
  WorkDone& operator+=(const WorkDone& other);
  // Adds everything to the statistics of the work since then, but clocks, which a session itself goes on with.
  void addTo(RenderStatistics& statistics) const;
};

}  // namespace wavecrest
