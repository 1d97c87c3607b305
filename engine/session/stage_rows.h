// The rows of --stats: one for each stage of a pass, filled from the workers' tallies.
#pragma once

#include "engine/session/session.h"
#include "engine/tasks/ticks.h"
#include "engine/walks/run_walk.h"

namespace wavecrest {

template <class S>
void addRows(const Pass<S>& pass, std::vector<RenderStatistics::StageRow>& rows) {
  rows.push_back({std::string(pass.generate.name)});
  for (const auto& stage : pass.firstDepth) rows.push_back({std::string(stage.name)});
  for (const auto& stage : pass.perDepth) rows.push_back({std::string(stage.name)});
  if (pass.splats) rows.push_back({"splat"});
}

// Adds tallies in the order of stages to the rows from `first` on.
inline void addTallies(const std::vector<StageTally>& tallies, size_t first,
                       std::vector<RenderStatistics::StageRow>& rows) {
  for (size_t i = 0; i < tallies.size(); ++i) {
    rows[first + i].items += tallies[i].items;
    rows[first + i].laneSlots += tallies[i].laneSlots;
    rows[first + i].seconds += static_cast<double>(tallies[i].ticks) * secondsPerTick();
  }
}

}  // namespace wavecrest
