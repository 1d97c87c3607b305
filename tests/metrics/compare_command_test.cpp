#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "metrics/image/atomic_file.h"
#include "metrics/image/image_io.h"
#include "metrics/metric_list.h"
#include "tests/metrics/compare_runner.h"
#include "tests/metrics/golden.h"
#include "tests/metrics/temporary_folder.h"

namespace wavecrest {
namespace {

using test::runCompare;

// How often a text has a part.
size_t countOf(const std::string& text, const std::string& part) {
  size_t count = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

// The embedded pictures of a page, in their order.
std::vector<std::string> picturesOf(const std::string& page) {
  const std::string begin = "src=\"data:image/png;base64,";
  std::vector<std::string> pictures;
  for (size_t at = page.find(begin); at != std::string::npos; at = page.find(begin, at + 1)) {
    const size_t first = at + begin.size();
    pictures.push_back(page.substr(first, page.find('"', first) - first));
  }
  return pictures;
}

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

TEST_F(CompareCommand, LeavesOutDefaultMetricsThatTheImageIsTooSmallFor) {
  const auto json = runCompare({golden("ref"), golden("test"), "--json"}).json();
  EXPECT_TRUE(json.contains("cvvdp"));
  EXPECT_FALSE(json.contains("msssim"));
}

TEST_F(CompareCommand, PrintsVersionsAndDisplaysThatScoresDependOn) {
  const auto run = runCompare({golden("ref"), golden("test"), "--metrics", "hdrvdp2,flip,hdrflip,cvvdp,pu21psnr"});
  EXPECT_NE(run.output.find("ColorVideoVDP v0.5.7, 75.4 [pix/deg]"), std::string::npos) << run.output;
  EXPECT_EQ(countOf(run.output, "(67.02 pixels per degree)"), 2u) << "of flip and hdrflip: " << run.output;
  const auto json = runCompare({golden("ref"), golden("test"), "--json"}).json();
  EXPECT_EQ(json["conditions"]["pu21psnr"], "PU21 banding_glare, linear 1.0 after --exposure shown at 100 cd/m2");
  EXPECT_EQ(json["conditions"]["hdrvdp2"], "HDR-VDP 2.2.0, sRGB display of 1 to 100 cd/m2, 30 pixels per degree");
  EXPECT_FALSE(json["conditions"].contains("rmse"));
  EXPECT_NEAR(json["cvvdp"], 8.877741813659668, 1e-4);
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

TEST_F(CompareCommand, RefusesOptionsThatNothingMeasuredDependsOn) {
  const auto refusal = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {golden("ref"), golden("test")});
    const auto run = runCompare(options);
    EXPECT_EQ(run.exitCode, run.error.empty() ? kExitDone : kExitUsage) << run.error;
    return run.error;
  };
  EXPECT_EQ(refusal({"--gamma", "--metrics", "ssim,flip"}),
            "--gamma: is for errors of values, which are not measured; expected rmse, relmse or mape among --metrics");
  EXPECT_EQ(refusal({"--exposure", "1", "--metrics", "rmse,hdrflip"}),
            "--exposure: changes nothing of what is measured; expected ssim, hdrvdp2, flip, msssim, pu21psnr, pu21ssim "
            "or cvvdp among --metrics, --gamma or --html");
  EXPECT_EQ(refusal({"--gamma", "--metrics", "ssim,mape"}), "");
  EXPECT_EQ(refusal({"--gamma", "--metrics", "flip", "--max-rmse", "1"}), "") << "a threshold has its metric measured";
  EXPECT_EQ(refusal({"--exposure", "1", "--metrics", "flip"}), "");
  EXPECT_EQ(refusal({"--exposure", "1", "--metrics", "rmse", "--gamma"}), "");
  EXPECT_EQ(refusal({"--exposure", "1", "--metrics", "rmse", "--html", files_.path("page.html")}), "");
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
  const auto missed =
      runCompare({golden("ref"), golden("ref"), "--metrics", "rmse", "--min-ssim", "1.0000000000000002"});
  EXPECT_EQ(missed.error, "wavecrest: check failed: ssim is 1; --min-ssim asks for 1.0000000000000002\n");
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
  const auto run = runCompare({golden("ref"), golden("test"), "--map", folder, "--metrics",
                               "rmse,relmse,mape,ssim,hdrvdp2,flip,hdrflip,pu21psnr,pu21ssim,cvvdp"});
  ASSERT_EQ(run.exitCode, kExitDone) << run.error;
  for (const Metric& metric : metricList()) {
    if (metric.smallestSide > 128) continue;
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
                                "rmse,relmse,mape,ssim,hdrvdp2,flip,hdrflip,pu21psnr,pu21ssim,cvvdp"})
                        .json();
  EXPECT_EQ(json["nonfinite_pixels"], 3);
  EXPECT_EQ(json["rmse"], 0.0);
  EXPECT_EQ(json["relmse"], 0.0);
  EXPECT_EQ(json["ssim"]["mean"], 1.0);
  EXPECT_EQ(json["flip"], 0.0);
  EXPECT_EQ(json["hdrflip"], 0.0);
  EXPECT_EQ(json["pu21psnr"], 100.0);
  EXPECT_EQ(json["pu21ssim"], 1.0);
  EXPECT_EQ(json["cvvdp"], 10.0);
}

TEST_F(CompareCommand, NonFinitePixelsAreExcludedFromErrorsOfCodes) {
  const Image a{32, 32, 3, std::vector<float>(32 * 32 * 3, 0.5f)}, b{32, 32, 3, std::vector<float>(32 * 32 * 3, 0.25f)};
  Image half = b;
  for (size_t i = 0; i < half.pixels.size() / 2; ++i) half.pixels[i] = std::numeric_limits<float>::quiet_NaN();
  writeExr(files_.path("a.exr"), a);
  writeExr(files_.path("b.exr"), b);
  writeExr(files_.path("half.exr"), half);
  const auto scores = [&](const std::string& test) {
    return runCompare({files_.path("a.exr"), files_.path(test), "--gamma", "--json", "--metrics", "rmse,relmse,mape"})
        .json();
  };
  const auto all = scores("b.exr"), some = scores("half.exr");
  for (const char* metric : {"rmse", "relmse", "mape"}) {
    EXPECT_GT(all[metric], 0.0) << metric;
    EXPECT_NEAR(some[metric], all[metric], 1e-6) << metric;  // floats in place of whole codes
  }
}

TEST_F(CompareCommand, NonFinitePixelsFailEveryCheck) {
  Image a{32, 32, 3, std::vector<float>(32 * 32 * 3, 0.5f)}, b = a;
  for (size_t i = 0; i < b.pixels.size() / 2; ++i) b.pixels[i] = std::numeric_limits<float>::quiet_NaN();
  writeExr(files_.path("a.exr"), a);
  writeExr(files_.path("b.exr"), b);
  const std::string good = files_.path("a.exr"), bad = files_.path("b.exr");
  for (const auto& [option, limit] : {std::pair{"--max-rmse", "0.1"}, {"--min-ssim", "0.5"}, {"--max-flip", "1"}}) {
    for (const auto& [reference, test] : {std::pair{good, bad}, {bad, good}}) {
      const auto run = runCompare({reference, test, "--metrics", "rmse", option, limit});
      EXPECT_EQ(run.exitCode, kExitCheck) << option;
      EXPECT_NE(run.error.find("512 of 1024 pixels are not finite"), std::string::npos) << run.error;
    }
    EXPECT_EQ(runCompare({good, good, "--metrics", "rmse", option, limit}).exitCode, kExitDone) << option;
  }
  EXPECT_EQ(runCompare({good, bad, "--metrics", "rmse"}).exitCode, kExitDone) << "nothing was asked for";
}

TEST_F(CompareCommand, SeveralTestsAreAnArrayAndEachMustHold) {
  const std::string ref = golden("ref"), test = golden("test");
  const auto json = runCompare({ref, ref, test, "--json", "--metrics", "rmse"}).json();
  ASSERT_EQ(json.size(), 2u);
  EXPECT_EQ(json[0]["test"], ref);
  EXPECT_EQ(json[0]["rmse"], 0.0);
  EXPECT_EQ(json[1]["test"], test);
  EXPECT_NEAR(json[1]["rmse"], 0.0516610712132, 1e-12);
  EXPECT_EQ(runCompare({ref, ref, test, "--max-rmse", "0.05", "--metrics", "rmse"}).exitCode, kExitCheck);
  EXPECT_EQ(runCompare({ref, test, ref, "--max-rmse", "0.05", "--metrics", "rmse"}).exitCode, kExitCheck);
  EXPECT_EQ(runCompare({ref, ref, ref, "--max-rmse", "0.05", "--metrics", "rmse"}).exitCode, kExitDone);
}

TEST_F(CompareCommand, MapsOfTestsOfOneNameLieApart) {
  std::filesystem::create_directories(files_.path("other"));
  writePng(files_.path("other/test.png"), test::patternImage(32, 32));
  writePng(files_.path("test.png"), test::patternImage(32, 32));
  const auto run = runCompare({files_.path("test.png"), files_.path("test.png"), files_.path("other/test.png"), "--map",
                               files_.path("maps"), "--metrics", "rmse"});
  ASSERT_EQ(run.exitCode, kExitDone) << run.error;
  EXPECT_EQ(readImage(files_.path("maps/test/rmse.png")).image.width, 32u);
  EXPECT_EQ(readImage(files_.path("maps/test.2/rmse.png")).image.width, 32u);
}

TEST_F(CompareCommand, CropComparesThatPartAlone) {
  Image a{40, 30, 3, std::vector<float>(40 * 30 * 3, 0.5f)}, b = a;
  b.pixels[3 * (12 * 40 + 20)] = 1.5f;  // of the pixel at (20, 12)
  writeExr(files_.path("a.exr"), a);
  writeExr(files_.path("b.exr"), b);
  const auto rmse = [&](const std::string& crop) -> double {
    const auto run =
        runCompare({files_.path("a.exr"), files_.path("b.exr"), "--metrics", "rmse", "--json", "--crop", crop});
    EXPECT_EQ(run.exitCode, kExitDone) << run.error;
    return run.json()["rmse"];
  };
  EXPECT_NEAR(rmse("20,12,1x1"), std::sqrt(1.0 / 3), 1e-7);
  EXPECT_NEAR(rmse("19,11,2x2"), std::sqrt(1.0 / 12), 1e-7);
  EXPECT_EQ(rmse("0,0,20x30"), 0.0);
  EXPECT_EQ(rmse("21,0,19x30"), 0.0);
  EXPECT_EQ(rmse("0,13,40x17"), 0.0);
  const auto refused = [&](const std::string& crop) {
    return runCompare({files_.path("a.exr"), files_.path("b.exr"), "--crop", crop}).exitCode;
  };
  EXPECT_EQ(refused("21,0,20x30"), kExitInput) << "beyond the image";
  for (const char* crop : {"0,0", "0,0,0x1", "a,0,1x1", "0,0,1x1x1", "-1,0,1x1", "0;0,1x1"}) {
    EXPECT_EQ(refused(crop), kExitUsage) << crop;
  }
}

TEST_F(CompareCommand, ThePageHoldsScoresImagesAndMaps) {
  const std::string page = files_.path("page.html");
  const auto run = runCompare({golden("ref"), golden("test"), golden("ref"), "--metrics", "rmse,flip", "--html", page});
  ASSERT_EQ(run.exitCode, kExitDone) << run.error;
  const std::vector<unsigned char> bytes = readFileBytes(page);
  const std::string text(bytes.begin(), bytes.end());
  EXPECT_EQ(countOf(text, "<img "), 1u + 2 * (1 + 2))
      << "the reference, and of each test itself and a map for each metric";
  EXPECT_NE(text.find("<td class=\"n\">0.0516611</td><td class=\"n best\">0</td>"), std::string::npos);
  EXPECT_EQ(text.find("src=\"http"), std::string::npos) << "it opens offline";
  EXPECT_NE(text.find("<div class=\"viewer\">"), std::string::npos) << "as reports have";
  EXPECT_NE(text.find("data-kind=\"FLIP\""), std::string::npos);
  EXPECT_NE(text.find("<div class=\"facts head\">FLIP: Andersson et al. 2020<span class=\"scale\">"),
            std::string::npos);
  EXPECT_NE(text.find("Andersson et al. 2020; less is better; 67.02 pixels per degree</small>"), std::string::npos);
  EXPECT_NE(text.find("; of half floats: light beyond 65504 counts as that"), std::string::npos) << "errors of crops";
  const auto onStdout =
      runCompare({golden("ref"), golden("test"), "--metrics", "rmse", "--html", "-", "--map", files_.path("maps")});
  EXPECT_EQ(onStdout.output.find("<!"), 0u) << "a page on stdout is alone there";
  EXPECT_EQ(onStdout.output.find("map " + files_.path("maps")), std::string::npos) << onStdout.output.substr(0, 80);
}

// Metrics leave such pixels out; pictures must not show the reference in their place.
TEST_F(CompareCommand, ThePageShowsPixelsThatAreNotFinite) {
  const auto write = [&](const std::string& name, float upper) {
    Image image{32, 32, 3, std::vector<float>(32 * 32 * 3, 0.5f)};
    std::fill_n(image.pixels.begin(), image.pixels.size() / 2, upper);
    writeExr(files_.path(name), image);
  };
  write("grey.exr", 0.5f);
  write("nan.exr", std::numeric_limits<float>::quiet_NaN());
  write("infinite.exr", std::numeric_limits<float>::infinity());
  const auto pictures = [&](const std::string& reference, const std::string& test) {
    const auto run = runCompare({files_.path(reference), files_.path(test), "--metrics", "rmse", "--html", "-"});
    std::vector<std::string> found = picturesOf(run.output);
    EXPECT_EQ(found.size(), 3u) << "reference, test and map; " << run.error;
    found.resize(3);
    return found;
  };
  const auto black = pictures("grey.exr", "nan.exr"), white = pictures("infinite.exr", "infinite.exr");
  EXPECT_NE(black[0], black[1]);
  EXPECT_EQ(white[0], white[1]) << "reference and test are drawn alike";
  EXPECT_NE(black[1], white[1]);
}

TEST_F(CompareCommand, ATestNamedReferenceHasAPaneOfItsOwn) {
  writePng(files_.path("a.png"), test::patternImage(32, 32));
  writePng(files_.path("reference.png"), test::patternImage(32, 32));
  const auto run = runCompare({files_.path("a.png"), files_.path("reference.png"), "--metrics", "rmse", "--html", "-"});
  EXPECT_EQ(countOf(run.output, "data-name=\"reference\""), 1u);
  EXPECT_EQ(countOf(run.output, "data-name=\"reference.2\""), 2u) << "its picture and its map";
}

TEST_F(CompareCommand, ThePageSaysTheExposureOfItsPictures) {
  const auto run =
      runCompare({linearCopy("ref"), linearCopy("test"), "--metrics", "rmse", "--exposure", "1.5", "--html", "-"});
  EXPECT_NE(run.output.find("<div class=\"viewer\" data-exposure=\"1.5\">"), std::string::npos);
}

TEST_F(CompareCommand, NoFileIsWrittenOverAnother) {
  writePng(files_.path("rmse.png"), test::patternImage(32, 32));
  writePng(files_.path("test.png"), test::patternImage(32, 32));
  const std::string reference = files_.path("rmse.png"), test = files_.path("test.png");
  EXPECT_EQ(runCompare({reference, test, "--map", files_.path("."), "--metrics", "rmse"}).exitCode, kExitUsage);
  EXPECT_EQ(runCompare({reference, test, "--html", test}).exitCode, kExitUsage);
  EXPECT_EQ(runCompare({reference, test, "--html", files_.path("absent/page.html")}).exitCode, kExitUsage);
  EXPECT_EQ(runCompare({reference, test, "--map", test + "/maps"}).exitCode, kExitUsage) << "a file is no folder";
  EXPECT_EQ(runCompare({reference, test, "--json", "--html", "-"}).exitCode, kExitUsage) << "both are for stdout";
  EXPECT_EQ(readImage(reference).image.width, 32u);
}

TEST_F(CompareCommand, ImagesTooSmallForADefaultMetricAreComparedByTheOthers) {
  writePng(files_.path("small.png"), test::patternImage(3, 2));
  const auto run = runCompare({files_.path("small.png"), files_.path("small.png"), "--json"});
  ASSERT_EQ(run.exitCode, kExitDone) << run.error;
  EXPECT_EQ(run.json()["rmse"], 0.0);
  EXPECT_FALSE(run.json().contains("ssim"));
  EXPECT_NE(run.error.find("too small for ssim"), std::string::npos) << run.error;
  EXPECT_EQ(runCompare({files_.path("small.png"), files_.path("small.png"), "--min-ssim", "0"}).exitCode, kExitInput);
}

TEST_F(CompareCommand, BadInputIsExitCode3WithOneClearLine) {
  writePng(files_.path("small.png"), test::patternImage(12, 12));
  writePng(files_.path("other.png"), test::patternImage(128, 127));
  Image allNan{20, 20, 3, std::vector<float>(1200, std::numeric_limits<float>::quiet_NaN())};
  writeExr(files_.path("nan.exr"), allNan);
  files_.write("broken.png", "not a png");
  const auto complaint = [&](const std::string& a, const std::string& b, const std::string& metrics = "hdrvdp2") {
    const auto run = runCompare({a, b, "--metrics", metrics});
    EXPECT_EQ(run.exitCode, kExitInput) << a;
    return run.error;
  };
  const auto contains = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
  EXPECT_PRED2(contains, complaint(golden("ref"), files_.path("other.png")), "expected 128x128");
  EXPECT_PRED2(contains, complaint(files_.path("small.png"), files_.path("small.png")), "at least 17x17");
  EXPECT_PRED2(contains, complaint(golden("ref"), golden("ref"), "msssim"), "at least 161x161");
  EXPECT_PRED2(contains, complaint(files_.path("nan.exr"), files_.path("nan.exr")), "no pixel is finite");
  EXPECT_PRED2(contains, complaint(golden("ref"), files_.path("broken.png")), "broken.png");
  EXPECT_PRED2(contains, complaint(golden("ref"), files_.path("missing.exr")), "No such file");
}

TEST_F(CompareCommand, DataWindowsThatBeginElsewhereAreNoted) {
  const Image light{4, 4, 3, std::vector<float>(48, 0.5f)};
  writeExr(files_.path("a.exr"), light);
  writeExr(files_.path("b.exr"), light);
  // Moves the data window of b to the right: x of its corners is the first and the third number of the box.
  const auto bytes = readFileBytes(files_.path("a.exr"));
  std::string moved(bytes.begin(), bytes.end());
  const size_t box = moved.find(std::string("dataWindow\0box2i\0", 17)) + 17 + 4;
  moved[box] = static_cast<char>(moved[box] + 2);
  moved[box + 8] = static_cast<char>(moved[box + 8] + 2);
  files_.write("moved.exr", moved);
  const auto notes = [&](const std::string& test) {
    const auto run = runCompare({files_.path("a.exr"), files_.path(test), "--metrics", "rmse"});
    EXPECT_EQ(run.exitCode, kExitDone);
    return run.error;
  };
  EXPECT_EQ(notes("b.exr"), "");
  EXPECT_NE(notes("moved.exr").find("begins at 0,0 and that of " + files_.path("moved.exr") + " at 2,0"),
            std::string::npos);
}

TEST_F(CompareCommand, LightBeyondPu21IsNoted) {
  Image light{4, 4, 3, std::vector<float>(48, 0.5f)};
  writeExr(files_.path("dim.exr"), light);
  light.pixels[4] = 101;  // 10100 cd/m2
  writeExr(files_.path("bright.exr"), light);
  const auto notes = [&](const std::string& test, const std::string& metric, const std::string& exposure) {
    return runCompare({files_.path("dim.exr"), files_.path(test), "--metrics", metric, "--exposure", exposure}).error;
  };
  EXPECT_NE(notes("bright.exr", "pu21psnr", "0").find("1 of 16 pixels of " + files_.path("bright.exr")),
            std::string::npos);
  EXPECT_EQ(notes("bright.exr", "pu21psnr", "-1"), "");
  EXPECT_EQ(notes("bright.exr", "rmse", "0"), "");
  EXPECT_EQ(notes("dim.exr", "pu21psnr", "0"), "");
  light.pixels[4] = std::numeric_limits<float>::infinity();
  writeExr(files_.path("infinite.exr"), light);
  EXPECT_EQ(notes("infinite.exr", "pu21psnr", "0"), "") << "excluded";
  writePng(files_.path("white.png"), Image8{.width = 4, .height = 4, .pixels = std::vector<uint8_t>(48, 255)});
  EXPECT_EQ(notes("white.png", "pu21psnr", "0"), "");
  EXPECT_NE(notes("white.png", "pu21psnr", "7").find("16 of 16 pixels of " + files_.path("white.png")),
            std::string::npos);
}

TEST_F(CompareCommand, OnePixelImagesAreComparedByTheMetricsThatCan) {
  writePng(files_.path("a.png"), test::patternImage(1, 1));
  const auto run = runCompare({files_.path("a.png"), files_.path("a.png"), "--json", "--metrics", "rmse,relmse,flip"});
  EXPECT_EQ(run.exitCode, kExitDone) << run.error;
}

}  // namespace
}  // namespace wavecrest
