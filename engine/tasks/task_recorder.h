// The graph of a render's tasks: how long each took, and which had to wait for which.
//
// A render is a sequence of steps with a barrier after each. A step has chains that do not wait for each other; the
// tasks of a chain follow one another. Iterations of a schedule (schedule.h) are one step, whose tasks wait as the
// schedule says. What runs between two steps on the calling thread is a step of one task.
// From this a schedule for any number of threads follows (bench/scaling/list_schedule.h).
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <vector>

#include "engine/tasks/schedule.h"

namespace wavecrest {

struct TaskStep {
  // Seconds of the tasks of each chain; of a schedule those of each iteration, phase after phase.
  std::vector<std::vector<double>> chains;
  bool goesOn = false;  // a longer render has longer chains, or more iterations, not more steps
  std::optional<Schedule> schedule = std::nullopt;
};

struct TaskGraph {
  std::vector<TaskStep> steps;
};

// Records what forEach and the waves of a session run while it lives. At most one lives at a time, and only one thread
// begins steps; tasks may run on any thread. Without a recorder, a step reads one pointer.
class TaskRecorder {
 public:
  using Clock = std::chrono::steady_clock;

  TaskRecorder();
  ~TaskRecorder();
  TaskRecorder(const TaskRecorder&) = delete;
  TaskRecorder& operator=(const TaskRecorder&) = delete;

  // What was recorded, up to now. The time of a step that its tasks do not account for is divided among them.
  TaskGraph graph();

  // Records a step for as long as this object lives. A step that begins while another one is being recorded is part of
  // a task of that one, and is not recorded by itself.
  class Step {
   public:
    explicit Step(size_t chains, bool goesOn = false);
    ~Step();
    Step(const Step&) = delete;
    Step& operator=(const Step&) = delete;

   private:
    friend class Task;
    friend class Iterations;
    friend class TaskRecorder;
    TaskRecorder* recorder_;  // nullptr: nothing is recorded
    Clock::time_point begin_;
    TaskStep tasks_;
  };

  // The next task of a chain.
  class Task {
   public:
    Task(Step& step, size_t chain);
    ~Task();
    Task(const Task&) = delete;
    Task& operator=(const Task&) = delete;

   private:
    std::vector<double>* chain_;
    Clock::time_point begin_;
  };

  // A step whose tasks are those of a schedule's iterations. Not safe from several threads.
  class Iterations {
   public:
    Iterations(const Schedule& schedule, uint64_t firstIteration);
    bool records() const { return step_.recorder_ != nullptr; }
    // The task took so many seconds.
    void add(const ScheduledTask& task, double seconds);

   private:
    Step step_;
    uint64_t first_;
  };

 private:
  void addSerial(Clock::time_point until);

  TaskGraph graph_;
  Clock::time_point end_;  // of the latest step
  bool within_ = false;    // a step
};

}  // namespace wavecrest
