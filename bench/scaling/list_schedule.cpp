#include "bench/scaling/list_schedule.h"

#include <algorithm>
#include <deque>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

namespace wavecrest {
namespace {

double sumOf(const std::vector<double>& tasks) { return std::accumulate(tasks.begin(), tasks.end(), 0.0); }

// Threads that begin and end tasks: end(task) and then take() for whoever is free. Returns when the last task ends.
template <class Task, class Take, class End>
double simulate(uint32_t threads, Take&& take, End&& end) {
  struct Running {
    double end;
    uint64_t order;  // of their beginning, where two end at once
    Task task;
    bool operator>(const Running& other) const { return std::pair(end, order) > std::pair(other.end, other.order); }
  };
  std::priority_queue<Running, std::vector<Running>, std::greater<>> running;
  double now = 0;
  uint64_t begun = 0;
  for (;;) {
    // Every free thread begins a task, while there are ready ones.
    while (running.size() < threads) {
      const std::optional<std::pair<Task, double>> taken = take();
      if (!taken) break;
      running.push({now + taken->second, begun++, taken->first});
    }
    if (running.empty()) return now;
    // The clock goes on to the next end of a task, which may make others ready.
    now = running.top().end;
    end(running.top().task);
    running.pop();
  }
}

// The sum of a figure over the steps of a render `times` as long: figure(step, how often it goes through its tasks).
template <class Figure>
double overSteps(const TaskGraph& graph, uint32_t times, Figure&& figure) {
  double seconds = 0;
  for (size_t i = 0; i < graph.steps.size(); ++i) {
    const TaskStep& step = graph.steps[i];
    if (step.goesOn) {
      seconds += figure(step, times);
    } else {
      // The first and the last step come once. Any other step is repeated, with its barrier.
      const bool once = i == 0 || i + 1 == graph.steps.size();
      seconds += (once ? 1 : times) * figure(step, 1);
    }
  }
  return seconds;
}

// Each chain runs through its tasks `times` times; chains take turns.
double scheduledChains(const TaskStep& step, uint32_t threads, uint32_t times) {
  std::deque<size_t> ready;
  std::vector<size_t> done(step.chains.size(), 0);
  for (size_t chain = 0; chain < step.chains.size(); ++chain) {
    if (!step.chains[chain].empty()) ready.push_back(chain);
  }
  return simulate<size_t>(
      threads,
      [&]() -> std::optional<std::pair<size_t, double>> {
        if (ready.empty()) return std::nullopt;
        const size_t chain = ready.front();
        ready.pop_front();
        const auto& tasks = step.chains[chain];
        return std::pair(chain, tasks[done[chain]++ % tasks.size()]);
      },
      [&](size_t chain) {
        // The chain waits for its next turn behind all others.
        if (done[chain] < times * step.chains[chain].size()) ready.push_back(chain);
      });
}

// The iterations come `times` times.
double scheduledIterations(const TaskStep& step, uint32_t threads, uint32_t times) {
  const Schedule& schedule = *step.schedule;
  // The place of each phase's first task in the recorded times of an iteration.
  std::vector<size_t> firstOfPhase(schedule.tasks.size());
  std::exclusive_scan(schedule.tasks.begin(), schedule.tasks.end(), firstOfPhase.begin(), size_t{0});
  // Iterations beyond the recorded ones take as long as the recorded ones, in the same order.
  const uint64_t recorded = step.chains.size();
  ScheduleState state(schedule, 0);
  const auto mayBegin = [end = times * recorded](uint64_t iteration, size_t) { return iteration < end; };
  return simulate<ScheduledTask>(
      threads,
      [&]() -> std::optional<std::pair<ScheduledTask, double>> {
        const std::optional<ScheduledTask> task = state.take(mayBegin);
        if (!task) return std::nullopt;
        return std::pair(*task, step.chains[task->iteration % recorded][firstOfPhase[task->phase] + task->index]);
      },
      [&](const ScheduledTask& task) { state.end(task); });
}

// When the last task of a step ends.
double scheduledStep(const TaskStep& step, uint32_t threads, uint32_t times) {
  return step.schedule ? scheduledIterations(step, threads, times) : scheduledChains(step, threads, times);
}

// Seconds of the longest sequence of tasks in a step that wait for each other.
double longestChain(const TaskStep& step, uint32_t times) {
  // As if there were a thread for each task.
  if (step.schedule) return scheduledIterations(step, std::numeric_limits<uint32_t>::max(), times);
  double longest = 0;
  for (const auto& chain : step.chains) longest = std::max(longest, sumOf(chain));
  return times * longest;
}

}  // namespace

double workOf(const TaskGraph& graph, uint32_t times) {
  return overSteps(graph, times, [](const TaskStep& step, uint32_t rounds) {
    double seconds = 0;
    for (const auto& chain : step.chains) seconds += sumOf(chain);
    return rounds * seconds;
  });
}

double spanOf(const TaskGraph& graph, uint32_t times) { return overSteps(graph, times, longestChain); }

double scheduledSeconds(const TaskGraph& graph, uint32_t threads, uint32_t times) {
  return overSteps(graph, times,
                   [threads](const TaskStep& step, uint32_t rounds) { return scheduledStep(step, threads, rounds); });
}

double longestTask(const TaskGraph& graph) {
  double longest = 0;
  for (const TaskStep& step : graph.steps) {
    for (const auto& chain : step.chains) {
      for (const double task : chain) longest = std::max(longest, task);
    }
  }
  return longest;
}

size_t taskCount(const TaskGraph& graph) {
  size_t count = 0;
  for (const TaskStep& step : graph.steps) {
    for (const auto& chain : step.chains) count += chain.size();
  }
  return count;
}

}  // namespace wavecrest
