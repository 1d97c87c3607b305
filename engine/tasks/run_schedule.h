// Runs a schedule's tasks on the threads of the current arena, as a TBB flow graph.
#pragma once

#include <functional>

#include "engine/tasks/schedule.h"

namespace wavecrest {

// Hands out tasks from firstIteration on, on `threads` threads, until no iteration is under way and mayBegin refuses
// the next. Iterations that have begun are finished. mayBegin is called by one thread at a time; run(task) by several.
// Returns the first iteration that did not begin. An exception of run or mayBegin ends the tasks and is thrown on.
//
// The graph has a node for each phase, which runs the phase's tasks, and one for the barriers between them: it hears of
// every task that is over and hands out those that may begin, by the policy of ScheduleState. Tasks belong to no
// worker, so no task waits for a thread that comes late.
uint64_t runSchedule(const Schedule& schedule, uint64_t firstIteration, size_t threads,
                     const ScheduleState::MayBegin& mayBegin, const std::function<void(const ScheduledTask&)>& run);

}  // namespace wavecrest
