#include <gtest/gtest.h>

#include <limits>

#include "metrics/image/image_io.h"
#include "metrics/metric_list.h"
#include "tests/metrics/compare_runner.h"
#include "tests/metrics/golden.h"
#include "tests/metrics/temporary_folder.h"

namespace wavecrest {
namespace {

using test::runCompare;

class CompareCommand : public ::testing::Test {
 protected:
  std::string golden(const std::string& which) const {
    return test::goldenPath("p1_cornell_128x128_" + which + ".png");
  }
  // The golden test image as linear light in an EXR.
  std::string linearCopy(const std::string& which) const {
    Image image = readImage(golden(which)).image;
    for (float& v : image.pixels) v = static_cast<float>(srgbDecode(double{v}));
    writeExr(files_.path(which + ".exr"), image);
    return files_.path(which + ".exr");
  }
  test::TemporaryFolder files_;
};

TEST_F(CompareCommand, JsonHasTheFixedShapeAndTheGoldenScores) {
  const auto run = runCompare({golden("ref"), golden("test"), "--json"});
  ASSERT_EQ(run.exitCode, kExitDone) << run.error;
  const auto json = run.json();
  EXPECT_NEAR(json["rmse"], 0.0516610712132, 1e-12);
  EXPECT_GT(json["relmse"], 0.0);
  EXPECT_GE(json["relmse"], json["relmse_trimmed"]);
  EXPECT_NEAR(json["ssim"]["mean"], 0.575429979541, 1e-6);
  EXPECT_NEAR(json["ssim"]["b"], 0.718851324533, 1e-6);
  EXPECT_NEAR(json["hdrvdp2"]["q"], -1.195341738, 1e-5);
  EXPECT_NEAR(json["hdrvdp2"]["q_mos"], 74.265092925, 1e-3);
  EXPECT_NEAR(json["flip"], 0.0860074705, 2e-5);
  EXPECT_EQ(json["nonfinite_pixels"], 0);
  EXPECT_FALSE(json.contains("hdrflip")) << "only on request";
}

TEST_F(CompareCommand, LinearImagesGiveLinearRmseAndTheSamePerceptualScores) {
  const auto json = runCompare({linearCopy("ref"), linearCopy("test"), "--json"}).json();
  EXPECT_NEAR(json["rmse"], 0.033804015737, 1e-8);
  EXPECT_NEAR(json["ssim"]["mean"], 0.575429979541, 1e-6);
  EXPECT_NEAR(json["flip"], 0.0860074705, 2e-5);
  const auto gamma =
      runCompare({linearCopy("ref"), linearCopy("test"), "--json", "--gamma", "--metrics", "rmse"}).json();
  EXPECT_NEAR(gamma["rmse"], 0.0516610712132, 1e-12);
  const auto mixed = runCompare({golden("ref"), linearCopy("test"), "--json", "--metrics", "rmse"}).json();
  EXPECT_NEAR(mixed["rmse"], 0.033804015737, 1e-8) << "a PNG against an EXR is compared as light";
}

TEST_F(CompareCommand, MeasuresOnlyTheNamedMetrics) {
  const auto json = runCompare({golden("ref"), golden("test"), "--json", "--metrics", "flip,rmse,hdrflip"}).json();
  EXPECT_TRUE(json.contains("rmse") && json.contains("flip") && json.contains("hdrflip"));
  EXPECT_FALSE(json.contains("ssim") || json.contains("hdrvdp2"));
  const auto run = runCompare({golden("ref"), golden("test"), "--metrics", "rmse,psnr"});
  EXPECT_EQ(run.exitCode, kExitUsage);
  EXPECT_NE(run.error.find("psnr"), std::string::npos);
}

TEST_F(CompareCommand, ThresholdsDecideBetweenExitCodes0And4) {
  const auto exitCode = [&](const std::string& option, const std::string& limit) {
    return runCompare({golden("ref"), golden("test"), "--metrics", "rmse", option, limit}).exitCode;
  };
  EXPECT_EQ(exitCode("--max-rmse", "0.0517"), kExitDone);
  EXPECT_EQ(exitCode("--max-rmse", "0.0516"), kExitCheck);
  EXPECT_EQ(exitCode("--min-ssim", "0.575"), kExitDone);
  EXPECT_EQ(exitCode("--min-ssim", "0.576"), kExitCheck);
  EXPECT_EQ(exitCode("--min-qmos", "74.26"), kExitDone);
  EXPECT_EQ(exitCode("--min-qmos", "74.27"), kExitCheck);
  EXPECT_EQ(exitCode("--max-flip", "0.087"), kExitDone);
  EXPECT_EQ(exitCode("--max-flip", "0.085"), kExitCheck);
  EXPECT_EQ(exitCode("--max-rmse", "abc"), kExitUsage);
}

TEST_F(CompareCommand, ExposureBrightensBeforeTheConversionTo8Bits) {
  Image dark{32, 32, 3, {}}, darker = dark;
  for (int i = 0; i < 32 * 32 * 3; ++i) {
    dark.pixels.push_back(2e-5f * static_cast<float>(i % 7));
    darker.pixels.push_back(2e-5f * static_cast<float>(i % 5));
  }
  writeExr(files_.path("a.exr"), dark);
  writeExr(files_.path("b.exr"), darker);
  const std::vector<std::string> command{files_.path("a.exr"), files_.path("b.exr"), "--json", "--metrics", "flip"};
  auto exposed = command;
  exposed.insert(exposed.end(), {"--exposure", "12"});
  EXPECT_EQ(runCompare(command).json()["flip"], 0.0) << "all codes are 0";
  EXPECT_GT(runCompare(exposed).json()["flip"], 0.01);
}

TEST_F(CompareCommand, MapsAreWrittenForEveryMetric) {
  const std::string folder = files_.path("maps");
  const auto run = runCompare(
      {golden("ref"), golden("test"), "--map", folder, "--metrics", "rmse,relmse,ssim,hdrvdp2,flip,hdrflip"});
  ASSERT_EQ(run.exitCode, kExitDone) << run.error;
  for (const Metric& metric : metricList()) {
    const Image map = readImage(folder + "/" + std::string(metric.name) + ".png").image;
    EXPECT_EQ(map.width, 128u);
    const auto [least, most] = std::minmax_element(map.pixels.begin(), map.pixels.end());
    EXPECT_GT(*most - *least, 0.3f) << metric.name << ": the map is flat";
  }
}

TEST_F(CompareCommand, NonFinitePixelsAreExcludedCountedAndReported) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  Image a{32, 32, 3, std::vector<float>(32 * 32 * 3, 0.5f)}, b = a;
  b.pixels[0] = nan;
  b.pixels[100] = inf;
  a.pixels[101] = -inf;  // the same pixel as 100
  a.pixels[2000] = nan;
  writeExr(files_.path("a.exr"), a);
  writeExr(files_.path("b.exr"), b);
  const auto json = runCompare({files_.path("a.exr"), files_.path("b.exr"), "--json", "--metrics",
                                "rmse,relmse,ssim,hdrvdp2,flip,hdrflip"})
                        .json();
  EXPECT_EQ(json["nonfinite_pixels"], 3);
  EXPECT_EQ(json["rmse"], 0.0);
  EXPECT_EQ(json["relmse"], 0.0);
  EXPECT_EQ(json["ssim"]["mean"], 1.0);
  EXPECT_EQ(json["flip"], 0.0);
  EXPECT_EQ(json["hdrflip"], 0.0);
}

TEST_F(CompareCommand, BadInputIsExitCode3WithOneClearLine) {
  writePng(files_.path("small.png"), test::patternImage(12, 12));
  writePng(files_.path("other.png"), test::patternImage(128, 127));
  Image allNan{20, 20, 3, std::vector<float>(1200, std::numeric_limits<float>::quiet_NaN())};
  writeExr(files_.path("nan.exr"), allNan);
  files_.write("broken.png", "not a png");
  const auto complaint = [&](const std::string& a, const std::string& b) {
    const auto run = runCompare({a, b});
    EXPECT_EQ(run.exitCode, kExitInput) << a;
    return run.error;
  };
  const auto contains = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
  EXPECT_PRED2(contains, complaint(golden("ref"), files_.path("other.png")), "expected 128x128");
  EXPECT_PRED2(contains, complaint(files_.path("small.png"), files_.path("small.png")), "at least 17x17");
  EXPECT_PRED2(contains, complaint(files_.path("nan.exr"), files_.path("nan.exr")), "no pixel is finite");
  EXPECT_PRED2(contains, complaint(golden("ref"), files_.path("broken.png")), "broken.png");
  EXPECT_PRED2(contains, complaint(golden("ref"), files_.path("missing.exr")), "No such file");
}

TEST_F(CompareCommand, OnePixelImagesAreComparedByTheMetricsThatCan) {
  writePng(files_.path("a.png"), test::patternImage(1, 1));
  const auto run = runCompare({files_.path("a.png"), files_.path("a.png"), "--json", "--metrics", "rmse,relmse,flip"});
  EXPECT_EQ(run.exitCode, kExitDone) << run.error;
}

}  // namespace
}  // namespace wavecrest
