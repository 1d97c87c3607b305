// What a page weighs: a mail takes eight megabytes, and nobody waits for more.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "bench/report/html_page.h"
#include "tests/bench/sample_report.h"

namespace wavecrest {
namespace {

size_t occurrences(const std::string& text, const std::string& part) {
  size_t found = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++found;
  return found;
}

// Nine scenes by seven methods with two seeds, as many snapshots as asked for, and pictures of pure noise.
ConvergenceReport largeReport(size_t snapshots, uint32_t width, uint32_t height) {
  ConvergenceReport report;
  report.title = "large";
  for (const char* name : {"rmse", "relmse", "ssim", "q_mos", "flip"}) {
    ReportMetric metric;
    metric.key = metric.name = name;
    report.metrics.push_back(metric);
  }
  const ReportImage picture = noiseImage("picture", width, height, 7);
  for (int s = 0; s < 9; ++s) {
    ReportScene scene;
    scene.name = "scene-" + std::to_string(s);
    scene.noiseFloors.resize(report.metrics.size());
    scene.reference = picture;
    for (const char* method : {"pt", "lt", "bpt", "mlt", "ppm", "bpm", "vcm"}) {
      ReportSeries series;
      series.method = series.label = method;
      series.finalImage = series.errorMap = picture;
      for (const uint64_t seed : {1u, 2u}) {
        ReportRun run{.seed = seed};
        for (size_t k = 1; k <= snapshots; ++k) {
          const double value = (1 + 0.1 * static_cast<double>(seed)) / std::sqrt(static_cast<double>(k));
          run.points.push_back({.number = static_cast<unsigned>(k),
                                .seconds = 6.0 * static_cast<double>(k),
                                .iterations = k,
                                .values = {}});
          run.points.back().values.assign(report.metrics.size(), value);
        }
        series.runs.push_back(std::move(run));
      }
      scene.series.push_back(std::move(series));
    }
    report.scenes.push_back(std::move(scene));
  }
  return report;
}

TEST(PageSize, staysBelowEightMegabytesForAStudyOfTheFullSize) {
  const std::string page = renderReport(largeReport(300, 512, 384));
  EXPECT_LT(page.size(), 8'000'000U);
  EXPECT_GT(occurrences(page, "data:image/jpeg"), 0U);
}

TEST(PageSize, doesNotGrowWithTheNumberOfSnapshots) {
  const size_t many = renderReport(largeReport(300, 16, 12)).size(),
               more = renderReport(largeReport(1200, 16, 12)).size();
  EXPECT_LT(static_cast<double>(more), 1.1 * static_cast<double>(many));
}

TEST(PageSize, embedsEachImageOnce) {
  const ConvergenceReport report = largeReport(5, 16, 12);
  // The reference, and of each method its last picture and error map.
  EXPECT_EQ(occurrences(renderReport(report), "data:image/"), 9U * (1 + 2 * 7));
}

}  // namespace
}  // namespace wavecrest
