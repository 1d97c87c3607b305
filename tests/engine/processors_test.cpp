// Processors that a process may run on, and the default number of threads.
#include "engine/tasks/processors.h"

#include <gtest/gtest.h>
#include <sched.h>

namespace wavecrest {
namespace {

// Pins the calling thread to the first of its processors until it is destroyed.
class OneProcessor {
 public:
  OneProcessor() {
    EXPECT_EQ(sched_getaffinity(0, sizeof(before_), &before_), 0);
    while (!CPU_ISSET(cpu_, &before_)) ++cpu_;
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(cpu_, &one);
    EXPECT_EQ(sched_setaffinity(0, sizeof(one), &one), 0);
  }
  ~OneProcessor() { sched_setaffinity(0, sizeof(before_), &before_); }
  OneProcessor(const OneProcessor&) = delete;
  OneProcessor& operator=(const OneProcessor&) = delete;
  uint32_t cpu() const { return static_cast<uint32_t>(cpu_); }

 private:
  cpu_set_t before_;
  int cpu_ = 0;
};

TEST(Processors, areThoseOfTheAffinityMask) {
  cpu_set_t mask;
  ASSERT_EQ(sched_getaffinity(0, sizeof(mask), &mask), 0);
  EXPECT_EQ(allowedProcessors(), static_cast<uint32_t>(CPU_COUNT(&mask)));
  const OneProcessor one;
  EXPECT_EQ(allowedProcessors(), 1u);
  EXPECT_EQ(processorsOfThisProcess(), std::vector<uint32_t>{one.cpu()});
}

TEST(Processors, eachHasAThreadUnlessANumberIsGiven) {
  EXPECT_EQ(threadsOrAll(0), allowedProcessors());
  EXPECT_EQ(threadsOrAll(7), 7u);
  const OneProcessor one;
  EXPECT_EQ(threadsOrAll(0), 1u);
  EXPECT_EQ(threadsOrAll(7), 7u);
}

}  // namespace
}  // namespace wavecrest
