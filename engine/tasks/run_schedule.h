// Runs a schedule's tasks on the threads of the current arena.
#pragma once

#include <functional>

#include "engine/tasks/schedule.h"

namespace wavecrest {

// Hands out tasks from firstIteration on, on `threads` threads, until no iteration is under way and mayBegin refuses
// the next. Iterations that have begun are finished. mayBegin is called by one thread at a time; run(task) by several.
// Returns the first iteration that did not begin. An exception of run or mayBegin ends the tasks and is thrown on.
uint64_t runSchedule(const Schedule& schedule, uint64_t firstIteration, size_t threads,
                     const ScheduleState::MayBegin& mayBegin, const std::function<void(const ScheduledTask&)>& run);

}  // namespace wavecrest
