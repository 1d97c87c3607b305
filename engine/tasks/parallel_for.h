// Pieces of preparing a scene on the threads of the current arena.
#pragma once

#include <cstddef>
#include <functional>

namespace wavecrest {

// Runs body(i) for each i in [0, count), in any order and on any thread, and returns when all are done. Bodies may call
// it again. Unlike forEach it takes no part in the record of a render's tasks (task_recorder.h).
void parallelFor(size_t count, const std::function<void(size_t)>& body);

}  // namespace wavecrest
