// What a recorded graph of tasks (engine/tasks/task_recorder.h) would take on other numbers of threads.
//
// As Cilkview does (He, Leiserson, Leiserson 2010): the work is the time of all tasks together, the span that of the
// longest sequence in which each waits for the one before; no number of threads is faster than work / span times one.
// A schedule says more: tasks go to whichever thread is free first, in the order in which they become ready (Graham
// 1969), as TBB's queue does. What threads cost each other in caches, memory and clock rate is in none of these.
#pragma once

#include <cstdint>

#include "engine/tasks/task_recorder.h"

namespace wavecrest {

// In seconds, of a render `times` as long as the recorded one, which is repeated for that. The first and the last step
// are what a render does at its beginning and end; they come once.
double workOf(const TaskGraph& graph, uint32_t times = 1);
double spanOf(const TaskGraph& graph, uint32_t times = 1);
double scheduledSeconds(const TaskGraph& graph, uint32_t threads, uint32_t times = 1);

// Tasks of the graph, and the seconds of the longest.
size_t taskCount(const TaskGraph& graph);
double longestTask(const TaskGraph& graph);

}  // namespace wavecrest
