#include "engine/tasks/task_recorder.h"

#include <numeric>
#include <utility>

namespace wavecrest {
namespace {

// The one recorder that lives, or nullptr.
TaskRecorder* currentRecorder = nullptr;

double between(TaskRecorder::Clock::time_point begin, TaskRecorder::Clock::time_point end) {
  return std::chrono::duration<double>(end - begin).count();
}

// Adds to each task its part of the time that the step took beyond its tasks. With several threads tasks take longer
// together than their step, and nothing is added.
void divideRest(TaskStep& step, double seconds) {
  size_t count = 0;
  for (const auto& chain : step.chains) {
    count += chain.size();
    for (const double task : chain) seconds -= task;
  }
  if (count == 0 || seconds <= 0) return;
  for (auto& chain : step.chains) {
    for (double& task : chain) task += seconds / static_cast<double>(count);
  }
}

}  // namespace

TaskRecorder::TaskRecorder() : end_(Clock::now()) { currentRecorder = this; }
TaskRecorder::~TaskRecorder() { currentRecorder = nullptr; }

// A step of one task: what ran on the calling thread since the latest step.
void TaskRecorder::addSerial(Clock::time_point until) {
  graph_.steps.push_back({.chains = {{between(end_, until)}}});
  end_ = until;
}

TaskGraph TaskRecorder::graph() {
  // The time since the latest step counts as a step too.
  addSerial(Clock::now());
  return graph_;
}

TaskRecorder::Step::Step(size_t chains, bool goesOn)
    : recorder_(currentRecorder != nullptr && !currentRecorder->within_ ? currentRecorder : nullptr) {
  if (recorder_ == nullptr) return;
  // The step begins here. The time before it is a serial step.
  tasks_ = {.chains = std::vector<std::vector<double>>(chains), .goesOn = goesOn};
  begin_ = Clock::now();
  recorder_->addSerial(begin_);
  recorder_->within_ = true;
}

TaskRecorder::Step::~Step() {
  if (recorder_ == nullptr) return;
  recorder_->end_ = Clock::now();
  recorder_->within_ = false;
  // Tasks share the time that none of them has measured.
  divideRest(tasks_, between(begin_, recorder_->end_));
  recorder_->graph_.steps.push_back(std::move(tasks_));
}

TaskRecorder::Iterations::Iterations(const Schedule& schedule, uint64_t firstIteration)
    : step_(0, true), first_(firstIteration) {
  if (records()) step_.tasks_.schedule = schedule;
}

void TaskRecorder::Iterations::add(const ScheduledTask& task, double seconds) {
  if (!records()) return;
  // Tasks end in any order. Iteration, phase and index say where a task's time belongs.
  const std::vector<size_t>& phases = step_.tasks_.schedule->tasks;
  std::vector<std::vector<double>>& iterations = step_.tasks_.chains;
  while (iterations.size() <= task.iteration - first_) iterations.emplace_back(step_.tasks_.schedule->taskCount());
  const size_t place = std::accumulate(phases.begin(), phases.begin() + static_cast<ptrdiff_t>(task.phase), task.index);
  iterations[task.iteration - first_][place] = seconds;
}

TaskRecorder::Task::Task(Step& step, size_t chain)
    : chain_(step.recorder_ == nullptr ? nullptr : &step.tasks_.chains[chain]) {
  if (chain_ != nullptr) begin_ = Clock::now();
}

TaskRecorder::Task::~Task() {
  if (chain_ != nullptr) chain_->push_back(between(begin_, Clock::now()));
}

}  // namespace wavecrest
