// Binds threads to hardware threads, and spreads memory over nodes, as a placement says.
//
// The system puts a page on the node of the thread that touches it first, so a bound thread's waves are on its own
// node. Tables that all threads read are spread over the nodes: the scene's while a session is built, before threads
// are bound, and the photon map's while it is built. On several nodes this replaces a memory policy that was set from
// outside (numactl).
#pragma once

#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_scheduler_observer.h>
#include <sched.h>
#include <sys/types.h>

#include <cstdint>
#include <vector>

#include "engine/tasks/placement.h"

namespace wavecrest {

// Binds the calling thread to one hardware thread; false where the system forbids it.
bool bindThread(uint32_t cpu);

// While it lives, threads are bound while they work in the arena; where there are more threads than the placement has
// hardware threads, the others are not. Outside of the arena a thread runs where it did before.
class ThreadPins final : public oneapi::tbb::task_scheduler_observer {
 public:
  ThreadPins(oneapi::tbb::task_arena& arena, Placement placement);
  ~ThreadPins() override;
  ThreadPins(const ThreadPins&) = delete;
  ThreadPins& operator=(const ThreadPins&) = delete;

  void on_scheduler_entry(bool) override;
  void on_scheduler_exit(bool) override;

 private:
  struct Before {
    cpu_set_t mask;
    pid_t thread = 0;  // 0: not bound
  };
  static void unbind(Before& before);
  const Placement placement_;
  std::vector<Before> before_;  // of the thread in each slot of the arena
};

// While it lives, new pages that this thread touches are spread over the placement's nodes, where it has several.
class SpreadMemory {
 public:
  explicit SpreadMemory(const Placement& placement);
  ~SpreadMemory();
  SpreadMemory(const SpreadMemory&) = delete;
  SpreadMemory& operator=(const SpreadMemory&) = delete;

 private:
  bool spread_ = false;
};

}  // namespace wavecrest
