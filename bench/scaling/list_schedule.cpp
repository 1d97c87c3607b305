#include "bench/scaling/list_schedule.h"

#include <algorithm>
#include <deque>
#include <functional>
#include <numeric>
#include <queue>
#include <utility>
#include <vector>

namespace wavecrest {
namespace {

double sumOf(const std::vector<double>& tasks) { return std::accumulate(tasks.begin(), tasks.end(), 0.0); }

double longestChain(const TaskStep& step) {
  double longest = 0;
  for (const auto& chain : step.chains) longest = std::max(longest, sumOf(chain));
  return longest;
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
      const bool once = i == 0 || i + 1 == graph.steps.size();
      seconds += (once ? 1 : times) * figure(step, 1);
    }
  }
  return seconds;
}

// When the last task of a step ends; each chain runs through its tasks `times` times.
double scheduledStep(const TaskStep& step, uint32_t threads, uint32_t times) {
  struct Running {
    double end;
    size_t chain;
    bool operator>(const Running& other) const { return std::pair(end, chain) > std::pair(other.end, other.chain); }
  };
  std::priority_queue<Running, std::vector<Running>, std::greater<>> running;
  std::deque<size_t> ready;
  std::vector<size_t> done(step.chains.size(), 0);
  for (size_t chain = 0; chain < step.chains.size(); ++chain) {
    if (!step.chains[chain].empty()) ready.push_back(chain);
  }
  double now = 0;
  while (!ready.empty() || !running.empty()) {
    while (!ready.empty() && running.size() < threads) {
      const size_t chain = ready.front();
      ready.pop_front();
      const auto& tasks = step.chains[chain];
      running.push({now + tasks[done[chain]++ % tasks.size()], chain});
    }
    now = running.top().end;
    const size_t chain = running.top().chain;
    running.pop();
    if (done[chain] < times * step.chains[chain].size()) ready.push_back(chain);
  }
  return now;
}

}  // namespace

double workOf(const TaskGraph& graph, uint32_t times) {
  return overSteps(graph, times, [](const TaskStep& step, uint32_t rounds) {
    double seconds = 0;
    for (const auto& chain : step.chains) seconds += sumOf(chain);
    return rounds * seconds;
  });
}

double spanOf(const TaskGraph& graph, uint32_t times) {
  return overSteps(graph, times, [](const TaskStep& step, uint32_t rounds) { return rounds * longestChain(step); });
}

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
