// The sweeps of bench/extremes: of some the ends in every run, all values of all on request.
#include <gtest/gtest.h>

#include <algorithm>

#include "bench/extremes/extremes_report.h"

namespace wavecrest {
namespace {

const std::vector<Sweep>& sweeps() {
  static const std::vector<Sweep> list = allSweeps();
  return list;
}
std::string nameOf(const testing::TestParamInfo<size_t>& test) {
  std::string name = sweeps()[test.param].name;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
  return name;
}
void expectWithinBounds(const Sweep& sweep, bool endsOnly) {
  const SweepResult result = runSweep(sweep, {.endsOnly = endsOnly, .seeds = 8, .threads = 1});
  ASSERT_FALSE(result.rows.empty());
  EXPECT_TRUE(result.passes()) << toText(result);
}

std::vector<size_t> ofEveryRun() {
  std::vector<size_t> list;
  for (size_t i = 0; i < sweeps().size(); ++i) {
    if (sweeps()[i].everyRun) list.push_back(i);
  }
  return list;
}

class SweepTest : public testing::TestWithParam<size_t> {};
TEST_P(SweepTest, endsAreWithinTheirBounds) { expectWithinBounds(sweeps()[GetParam()], true); }
INSTANTIATE_TEST_SUITE_P(Extremes, SweepTest, testing::ValuesIn(ofEveryRun()), nameOf);

class LongSweepTest : public testing::TestWithParam<size_t> {};
TEST_P(LongSweepTest, allIsWithinItsBound) { expectWithinBounds(sweeps()[GetParam()], false); }
INSTANTIATE_TEST_SUITE_P(Extremes, LongSweepTest, testing::Range(size_t{0}, sweeps().size()), nameOf);

// A sweep in which every method has rows or a reason to have none.
TEST(SweepList, leavesNoMethodOutSilently) {
  // evcm renders by one of the others.
  const auto methods = std::ranges::count_if(kMethods, [](const auto& one) { return !isChosenByTrials(one.method); });
  for (const Sweep& sweep : sweeps()) {
    EXPECT_FALSE(sweep.boundSource.empty()) << sweep.name;
    EXPECT_TRUE(std::ssize(sweep.methods) == methods || !sweep.leftOut.empty()) << sweep.name;
    EXPECT_GT(sweep.bound, 0) << sweep.name;
  }
}

// The judgement itself: a wrong answer, noise, and lost samples do not pass.
TEST(Sweeps, failWhereTheAnswerIsAnother) {
  Sweep sweep = *std::find_if(sweeps().begin(), sweeps().end(), [](const Sweep& s) { return s.name == "samples"; });
  sweep.values = {16};
  EXPECT_TRUE(runSweep(sweep, {}).passes());
  sweep.truth = [](double) { return 1 + 1e-6; };
  EXPECT_FALSE(runSweep(sweep, {}).passes());
}
TEST(Sweeps, failWhereNoiseHidesTheAnswer) {
  Sweep sweep = *std::find_if(sweeps().begin(), sweeps().end(), [](const Sweep& s) { return s.name == "albedo"; });
  sweep.values = {0.1};
  sweep.samples = [](double) { return uint64_t{1}; };
  sweep.resolution = 1e-5;
  EXPECT_FALSE(runSweep(sweep, {}).passes());
}

}  // namespace
}  // namespace wavecrest
