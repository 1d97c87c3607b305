#include "engine/tasks/schedule.h"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace wavecrest {

size_t Schedule::taskCount() const { return std::accumulate(tasks.begin(), tasks.end(), size_t{0}); }

const ScheduleState::Phase* ScheduleState::phaseOf(uint64_t iteration, size_t phase) const {
  const uint64_t place = iteration - first_;
  return place < begun_.size() ? &begun_[place].phases[phase] : nullptr;
}

bool ScheduleState::isOver(uint64_t iteration, size_t phase) const {
  if (iteration < first_) return true;
  const Phase* const state = phaseOf(iteration, phase);
  return state != nullptr && state->over == schedule_.tasks[phase];
}

size_t ScheduleState::readyOf(uint64_t iteration, size_t phase, size_t taken) const {
  // The phase before must be over. Each wait that is not met yet lets fewer tasks begin.
  if (phase > 0 && !isOver(iteration, phase - 1)) return 0;
  size_t most = schedule_.tasks[phase];
  for (const ScheduleWait& wait : schedule_.waits) {
    // Iterations before the first one under way are over.
    if (wait.phase != phase || iteration < first_ + wait.earlier || isOver(iteration - wait.earlier, wait.on)) continue;
    const Phase* const on = phaseOf(iteration - wait.earlier, wait.on);
    most = std::min(most, wait.sameTask && on != nullptr ? on->first : wait.ahead);
  }
  return std::max(most, taken) - taken;
}

size_t ScheduleState::readyAt(uint64_t place) const {
  const Iteration& iteration = begun_[place];
  if (iteration.next == iteration.phases.size()) return 0;
  return readyOf(first_ + place, iteration.next, iteration.phases[iteration.next].taken);
}

std::optional<ScheduledTask> ScheduleState::take(const MayBegin& mayBegin) {
  const auto takeOf = [this](uint64_t place, size_t phase) {
    Iteration& iteration = begun_[place];
    const ScheduledTask task{first_ + place, phase, iteration.phases[phase].taken++};
    if (iteration.phases[phase].taken == schedule_.tasks[phase]) ++iteration.next;
    return task;
  };
  // Look for a task in the iterations under way, the oldest first.
  for (size_t place = 0; place < begun_.size(); ++place) {
    if (readyAt(place) != 0) return takeOf(place, begun_[place].next);
  }
  // Without such a task, begin the next iteration if that is allowed.
  const uint64_t next = first_ + begun_.size();
  if (readyOf(next, 0, 0) == 0 || !mayBegin(next, begun_.size())) return std::nullopt;
  Iteration& begun = begun_.emplace_back();
  begun.phases.resize(schedule_.tasks.size());
  for (size_t phase = 0; phase < begun.phases.size(); ++phase) {
    begun.phases[phase].isOver.resize(schedule_.tasks[phase]);
  }
  return takeOf(begun_.size() - 1, 0);
}

void ScheduleState::end(const ScheduledTask& task) {
  assert(task.iteration >= first_ && task.iteration - first_ < begun_.size());
  Phase& phase = begun_[task.iteration - first_].phases[task.phase];
  ++phase.over;
  phase.isOver[task.index] = true;
  // Tasks end in any order. All tasks before `first` are over.
  while (phase.first < phase.isOver.size() && phase.isOver[phase.first]) ++phase.first;
  // Drop the oldest iterations whose last phase is over.
  while (!begun_.empty() && begun_.front().phases.back().over == schedule_.tasks.back()) {
    begun_.pop_front();
    ++first_;
  }
}

}  // namespace wavecrest
