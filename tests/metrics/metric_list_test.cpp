// What the list of metrics promises: to tables that hold scores of all of them, and to pictures of maps.
#include "metrics/metric_list.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "metrics/false_colour.h"

namespace wavecrest {
namespace {

// A black square with the first rows of another level.
ImageFile topRows(float level) {
  constexpr uint32_t kSide = 200, kRows = 3;
  Image image{kSide, kSide, 3, std::vector<float>(size_t{kSide} * kSide * 3)};
  std::fill_n(image.pixels.begin(), kRows * kSide * 3, level);
  return {std::move(image), Encoding::linear, {}};
}

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

// The relative errors are beyond the largest float, and so many that the range of the picture is one of them.
TEST(MetricList, mapsOfFirefliesEndAtTheTopOfTheScale) {
  const PreparedReference reference("black", topRows(0));
  const ComparedImage test = reference.prepareTest("fireflies", topRows(1e30f));
  const Measurement measured = findMetric("relmse")->measure(reference, test, true);
  const double range = quantile(measured.map, 0.999);
  EXPECT_TRUE(std::isfinite(range));
  const Image8 picture = falseColour(measured.map, 200, 200, range);
  const auto worst = picture.pixels.begin(), best = picture.pixels.end() - 3;
  EXPECT_EQ(std::vector<uint8_t>(worst, worst + 3), (std::vector<uint8_t>{252, 253, 191}));
  EXPECT_EQ(std::vector<uint8_t>(best, best + 3), (std::vector<uint8_t>{0, 0, 4}));
}

// The difference of the two levels is beyond the largest float, and so is the sample times 100 cd/m2.
TEST(MetricList, mapsOfTheGreatestLightAreFinite) {
  const PreparedReference reference("dark", topRows(-3e38f));
  const ComparedImage test = reference.prepareTest("bright", topRows(3e38f));
  for (const Metric& metric : metricList()) {
    const Measurement measured = metric.measure(reference, test, true);
    ASSERT_EQ(measured.map.size(), size_t{200} * 200) << metric.name;
    EXPECT_TRUE(std::all_of(measured.map.begin(), measured.map.end(), [](float v) { return std::isfinite(v); }))
        << metric.name;
    EXPECT_GT(measured.map.front(), measured.map.back()) << metric.name;
  }
}

// Most pixels are not finite; the exposures are those of the others.
TEST(MetricList, excludedPixelsDoNotChooseExposuresOfHdrFlip) {
  ImageFile whole = topRows(8), part = topRows(8);
  for (float& value : whole.image.pixels) value = 8;
  for (size_t i = size_t{3} * 200 * 3; i < part.image.pixels.size(); i += 3) {
    part.image.pixels[i] = 1e5f;  // the other channels of a pixel do not count either
    part.image.pixels[i + 1] = std::numeric_limits<float>::quiet_NaN();
    part.image.pixels[i + 2] = std::numeric_limits<float>::infinity();
  }
  const PreparedReference a("whole", std::move(whole)), b("part", part);
  EXPECT_EQ(b.hdrFlip().exposures(), a.hdrFlip().exposures());
  EXPECT_EQ(findMetric("hdrflip")->measure(b, b.prepareTest("part", part), false).scores[0].value, 0.0);
}

}  // namespace
}  // namespace wavecrest
