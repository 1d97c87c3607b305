// Counters are those of the calling thread. Tested with events that Linux counts itself, as virtual machines often have
// no others.
#include "bench/machine/perf_events.h"

#include <gtest/gtest.h>
#include <linux/perf_event.h>

#include <array>
#include <vector>

#include "bench/machine/cpu_timer.h"

namespace wavecrest {
namespace {

// Counts nanoseconds of the thread's CPU time, and nothing.
constexpr PerfEvent kTime{PERF_TYPE_SOFTWARE, PERF_COUNT_SW_TASK_CLOCK};
constexpr PerfEvent kNothing{PERF_TYPE_SOFTWARE, PERF_COUNT_SW_DUMMY};
constexpr double kWork = 2e-3;  // seconds of CPU time, which other programs cannot shorten

void work() {
  const double begin = threadCpuSeconds();
  while (threadCpuSeconds() - begin < kWork) {
  }
}

TEST(PerfGroup, countsEachEventInItsPlace) {
  const PerfEvent events[] = {kNothing, kTime, kNothing};
  const PerfGroup group(events);
  if (!group.refusal().empty()) GTEST_SKIP() << group.refusal();
  std::vector<uint64_t> before(3), after(3);
  group.read(before);
  work();
  group.read(after);
  EXPECT_EQ(after[0], 0u);
  EXPECT_GT(static_cast<double>(after[1] - before[1]), 0.9e9 * kWork);
  EXPECT_EQ(after[2], 0u);
}

TEST(PerfGroup, saysWhyItDoesNotCount) {
  const PerfEvent events[] = {kTime, {PERF_TYPE_SOFTWARE, ~uint64_t{0}}};
  const PerfGroup group(events);
  EXPECT_NE(group.refusal(), "");
  std::vector<uint64_t> counts(2, 7);
  group.read(counts);
  EXPECT_EQ(counts, (std::vector<uint64_t>{0, 0})) << "no part of a group is taken for all of it";
}

TEST(StageEventCounter, addsUpWhatHappenedInEachStage) {
  StageEventCounter counter(std::array{kNothing, kTime, kNothing});
  if (!counter.refusal().empty()) GTEST_SKIP() << counter.refusal();
  StageObserver* const observer = stageObserver;
  ASSERT_EQ(observer, &counter);
  for (int i = 0; i < 2; ++i) {
    observer->begin();
    work();
    observer->end("working");
    work();
    observer->begin();
    observer->end("idle");
  }
  const std::map<std::string, StageEvents> counts = counter.take();
  ASSERT_EQ(counts.size(), 2u);
  EXPECT_GT(static_cast<double>(counts.at("working")[1]), 0.9e9 * 2 * kWork);
  EXPECT_LT(static_cast<double>(counts.at("idle")[1]), 1e9 * kWork) << "work between stages is no stage's";
  EXPECT_EQ(counts.at("working")[0], 0u);
  EXPECT_TRUE(counter.take().empty());
}

TEST(StageEventCounter, observesNothingItCannotCount) {
  constexpr PerfEvent kUnknown{PERF_TYPE_SOFTWARE, ~uint64_t{0}};
  const StageEventCounter counter(std::array{kUnknown, kNothing, kNothing});
  EXPECT_NE(counter.refusal(), "");
  EXPECT_EQ(stageObserver, nullptr);
}

}  // namespace
}  // namespace wavecrest
