// What TBB orders, told to ThreadSanitizer.
//
// Debian's TBB is compiled without the sanitizer, which therefore sees neither that a task comes after what spawned it
// nor that whoever waits for tasks comes after them, and would call everything they share a race. These calls state
// those two orders and no other: tasks remain unordered among each other. Without the sanitizer they are nothing.
#pragma once

#if defined(__SANITIZE_THREAD__)
#include <sanitizer/tsan_interface.h>
// For the function that TBB calls, which finds its captures in TBB's memory before it has made a Task.
#define WAVECREST_TASK_ENTRY __attribute__((no_sanitize_thread))
#else
#define WAVECREST_TASK_ENTRY
#endif

namespace wavecrest {

// All that this thread has done comes before what follows observe() of the same token elsewhere.
inline void publish([[maybe_unused]] void* token) {
#if defined(__SANITIZE_THREAD__)
  __tsan_release(token);
#endif
}
inline void observe([[maybe_unused]] void* token) {
#if defined(__SANITIZE_THREAD__)
  __tsan_acquire(token);
#endif
}

// Tasks that are spawned after the construction and over before wait(); each runs within a Task.
class TaskOrder {
 public:
  TaskOrder() { publish(&spawned_); }
  void wait() { observe(&over_); }

  class Task {
   public:
    explicit Task(TaskOrder& order) : order_(order) { observe(&order_.spawned_); }
    ~Task() { publish(&order_.over_); }
    Task(const Task&) = delete;
    Task& operator=(const Task&) = delete;

   private:
    TaskOrder& order_;
  };

 private:
  char spawned_ = 0, over_ = 0;  // tokens: their addresses count
};

}  // namespace wavecrest
