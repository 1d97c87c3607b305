// Pilots last as long as they were given, by either clock.
#include "bench/recommend/pilot_renders.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <stdexcept>

namespace wavecrest {
namespace {

// Renders nothing. As chains do, it stops `early` seconds before each end, and a call that stops at once takes time
// too.
class PacedSession : public Session {
 public:
  PacedSession(double early, double cpuPart) : early_(early), cpuPart_(cpuPart) {}

  void renderUntil(std::optional<uint64_t>, std::optional<double> seconds) override {
    constexpr double kLeast = 1e-6;
    ++calls;
    seconds_ = std::max(seconds_ + kLeast, seconds.value_or(0) - early_);
  }
  RenderStatistics statistics() const override {
    RenderStatistics out;
    out.renderSeconds = seconds_;
    out.cpuSeconds = cpuPart_ * seconds_;
    return out;
  }
  const Film& film() const override { throw std::logic_error("no film"); }
  const MemoryPlan& memoryPlan() const override { throw std::logic_error("no plan"); }
  void save(StateWriter&) const override {}
  void restore(StateReader&) override {}
  double progressSeconds() const override { return seconds_; }
  uint64_t progressPaths() const override { return 0; }

  size_t calls = 0;

 private:
  const double early_, cpuPart_;
  double seconds_ = 0;
};

TEST(RenderBy, endsWhereAnotherStepDoesNotFitIn) {
  PacedSession session(0.05, 1);
  renderBy(ClockKind::wall, session, 1, 1);
  EXPECT_EQ(session.calls, 1u);
}

// Half of the wall time goes to other processes.
TEST(RenderBy, goesOnUntilTheProcessorTimeIsSpent) {
  PacedSession session(0, 0.5);
  renderBy(ClockKind::cpu, session, 1, 1);
  EXPECT_GE(session.statistics().cpuSeconds, 0.98);
  EXPECT_LE(session.statistics().cpuSeconds, 1);
}

}  // namespace
}  // namespace wavecrest
