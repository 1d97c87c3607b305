#include "engine/tasks/thread_pins.h"

#include <linux/mempolicy.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

namespace wavecrest {
namespace {

constexpr size_t kBitsPerWord = 8 * sizeof(unsigned long);

// How new pages of the calling thread are placed; a policy that the system refuses changes nothing.
bool setMemoryPolicy(int mode, const std::vector<unsigned long>& nodes = {}) {
  const unsigned long* const mask = nodes.empty() ? nullptr : nodes.data();
  // The kernel leaves out the last bit that it is told of.
  const unsigned long bits = nodes.empty() ? 0 : nodes.size() * kBitsPerWord + 1;
  return syscall(SYS_set_mempolicy, mode, mask, bits) == 0;
}

}  // namespace

bool bindThread(uint32_t cpu) {
  // A cpu_set_t has room for CPU_SETSIZE hardware threads.
  if (cpu >= CPU_SETSIZE) return false;
  cpu_set_t mask;
  CPU_ZERO(&mask);
  CPU_SET(cpu, &mask);
  return sched_setaffinity(0, sizeof mask, &mask) == 0;
}

ThreadPins::ThreadPins(oneapi::tbb::task_arena& arena, Placement placement)
    : task_scheduler_observer(arena), placement_(std::move(placement)), before_(placement_.cpus.size()) {
  if (!placement_.cpus.empty()) observe(true);
}

// Threads that are still in the arena have no on_scheduler_exit any more.
ThreadPins::~ThreadPins() {
  observe(false);
  for (Before& before : before_) unbind(before);
}

void ThreadPins::unbind(Before& before) {
  if (before.thread != 0) sched_setaffinity(before.thread, sizeof before.mask, &before.mask);
  before.thread = 0;
}

void ThreadPins::on_scheduler_entry(bool) {
  // The thread's slot in the arena decides where the thread is bound.
  const auto slot = static_cast<size_t>(oneapi::tbb::this_task_arena::current_thread_index());
  if (slot >= placement_.cpus.size()) return;
  Before& before = before_[slot];
  const bool bound = sched_getaffinity(0, sizeof before.mask, &before.mask) == 0 && bindThread(placement_.cpus[slot]);
  before.thread = bound ? gettid() : 0;
  // A thread that was started while memory was spread inherited that.
  if (placement_.nodes.size() > 1) setMemoryPolicy(MPOL_DEFAULT);
}

void ThreadPins::on_scheduler_exit(bool) {
  const auto slot = static_cast<size_t>(oneapi::tbb::this_task_arena::current_thread_index());
  if (slot < placement_.cpus.size()) unbind(before_[slot]);
}

SpreadMemory::SpreadMemory(const Placement& placement) {
  if (placement.nodes.size() < 2) return;
  // The mask has a bit for each node.
  std::vector<unsigned long> mask;
  for (const uint32_t node : placement.nodes) {
    mask.resize(std::max(mask.size(), node / kBitsPerWord + 1));
    mask[node / kBitsPerWord] |= 1ul << (node % kBitsPerWord);
  }
  spread_ = setMemoryPolicy(MPOL_INTERLEAVE, mask);
}

SpreadMemory::~SpreadMemory() {
  if (spread_) setMemoryPolicy(MPOL_DEFAULT);
}

}  // namespace wavecrest
