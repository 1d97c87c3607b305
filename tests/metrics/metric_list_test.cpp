// What the list of metrics promises to tables that hold scores of all of them.
#include "metrics/metric_list.h"

#include <gtest/gtest.h>

#include <set>

namespace wavecrest {
namespace {

TEST(MetricList, scoresOfAllMetricsHaveNamesOfTheirOwn) {
  EXPECT_EQ(scoreName(*findMetric("rmse"), ""), "rmse");
  EXPECT_EQ(scoreName(*findMetric("relmse"), "trimmed"), "relmse_trimmed");
  EXPECT_EQ(scoreName(*findMetric("ssim"), "mean"), "ssim");
  EXPECT_EQ(scoreName(*findMetric("ssim"), "r"), "ssim_r");
  EXPECT_EQ(scoreName(*findMetric("hdrvdp2"), "q_mos"), "q_mos");
  EXPECT_EQ(scoreName(*findMetric("hdrvdp2"), "q"), "q");
  std::set<std::string> mains;
  for (const Metric& metric : metricList()) mains.insert(scoreName(metric, metric.score));
  EXPECT_EQ(mains.size(), metricList().size());
}

}  // namespace
}  // namespace wavecrest
