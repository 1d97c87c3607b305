// Independent pieces of work on the threads of the current arena.
#pragma once

#include <cstddef>
#include <functional>

namespace wavecrest {

// Runs body(i) for each i in [0, count), in any order and on any thread, and returns when all are done.
void forEach(size_t count, const std::function<void(size_t)>& body);

// Runs turn(i) for each i in [0, count) again and again until it returns false, and returns when all have. Turns of one
// i follow each other; whoever had a turn waits behind all others, so that all get on together. threads: of the arena.
// An exception of a turn ends them all.
void takeTurns(size_t count, size_t threads, const std::function<bool(size_t)>& turn);

}  // namespace wavecrest
