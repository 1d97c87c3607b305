// forEach: independent pieces of work on the threads of the current arena.
#pragma once

#include <cstddef>
#include <functional>

namespace wavecrest {

// Runs body(i) for each i in [0, count), in any order and on any thread, and returns when all are done.
void forEach(size_t count, const std::function<void(size_t)>& body);

}  // namespace wavecrest
