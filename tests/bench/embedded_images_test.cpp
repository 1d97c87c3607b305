// Images inside the page: base64, PNG and JPEG, and the choice between them by what a page may weigh.
#include "bench/report/embedded_images.h"

#include <gtest/gtest.h>
#include <png.h>
#include <cstdio>
// After <cstdio>: jpeglib.h uses FILE without declaring it.
#include <jpeglib.h>

#include <cmath>
#include <stdexcept>
#include <string_view>

#include "tests/bench/sample_report.h"

namespace wavecrest {
namespace {

std::string base64Of(std::string_view text) {
  return base64({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

ReportImage gradient(uint32_t width, uint32_t height) {
  ReportImage image{.label = "gradient", .width = width, .height = height, .rgb = {}};
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; ++x)
      for (const uint32_t value : {x * 255 / width, y * 255 / height, (x + y) % 64})
        image.rgb.push_back(static_cast<uint8_t>(value));
  return image;
}

std::vector<uint8_t> decodedPng(const std::vector<uint8_t>& bytes) {
  png_image header = {};
  header.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_memory(&header, bytes.data(), bytes.size()), 0) << header.message;
  header.format = PNG_FORMAT_RGB;
  std::vector<uint8_t> rgb(PNG_IMAGE_SIZE(header));
  EXPECT_NE(png_image_finish_read(&header, nullptr, rgb.data(), 0, nullptr), 0) << header.message;
  return rgb;
}

// libjpeg's own reader; its default handler ends the process on errors, which is a failure too.
ReportImage decodedJpeg(const std::vector<uint8_t>& bytes) {
  jpeg_decompress_struct info{};
  jpeg_error_mgr errors{};
  info.err = jpeg_std_error(&errors);
  jpeg_create_decompress(&info);
  jpeg_mem_src(&info, bytes.data(), static_cast<unsigned long>(bytes.size()));
  jpeg_read_header(&info, TRUE);
  info.out_color_space = JCS_RGB;
  jpeg_start_decompress(&info);
  ReportImage image{.width = info.output_width, .height = info.output_height};
  image.rgb.resize(size_t{3} * image.width * image.height);
  while (info.output_scanline < info.output_height) {
    JSAMPROW row = image.rgb.data() + size_t{3} * image.width * info.output_scanline;
    jpeg_read_scanlines(&info, &row, 1);
  }
  jpeg_finish_decompress(&info);
  jpeg_destroy_decompress(&info);
  return image;
}

double rootMeanSquareDifference(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += (double(a[i]) - b[i]) * (double(a[i]) - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

TEST(Base64, testVectorsOfRfc4648) {
  EXPECT_EQ(base64Of(""), "");
  EXPECT_EQ(base64Of("f"), "Zg==");
  EXPECT_EQ(base64Of("fo"), "Zm8=");
  EXPECT_EQ(base64Of("foo"), "Zm9v");
  EXPECT_EQ(base64Of("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64Of("\xfb\xff"), "+/8=");
}

TEST(ImageCoding, pngKeepsEveryCode) {
  const ReportImage image = noiseImage("noise", 37, 23, 1);
  EXPECT_EQ(decodedPng(encodeImage(image, {})), image.rgb);
}

// A gradient in red and green with stripes in blue: without colour subsampling the stripes survive.
TEST(ImageCoding, jpegKeepsSizeAndColours) {
  const ReportImage image = gradient(61, 47);
  const ReportImage back = decodedJpeg(encodeImage(image, {.jpegQuality = 92}));
  EXPECT_EQ(back.width, 61U);
  EXPECT_EQ(back.height, 47U);
  EXPECT_LT(rootMeanSquareDifference(back.rgb, image.rgb), 5);
}

TEST(ImageCoding, reductionAveragesBlocksAndWhatIsLeftAtTheEdges) {
  ReportImage image{.label = "", .width = 3, .height = 2, .rgb = {}};
  for (const int value : {10, 20, 90, 30, 40, 110})
    for (int c = 0; c < 3; ++c) image.rgb.push_back(static_cast<uint8_t>(value + c));
  const ReportImage half = reduced(image, 2);
  EXPECT_EQ(half.width, 2U);
  EXPECT_EQ(half.height, 1U);
  EXPECT_EQ(half.rgb, (std::vector<uint8_t>{25, 26, 27, 100, 101, 102}));
}

TEST(ImageCoding, refusesPixelsThatDoNotFitTheSize) {
  EXPECT_THROW(encodeImage({.label = "short", .width = 2, .height = 2, .rgb = {1, 2, 3}}, {}), std::invalid_argument);
  EXPECT_THROW(encodeImage({.label = "empty", .width = 0, .height = 0, .rgb = {}}, {}), std::invalid_argument);
}

TEST(EmbeddedImages, staysWithinItsBudgetByFallingQualityThenSize) {
  ConvergenceReport report;
  report.scenes.resize(1);
  report.scenes[0].reference = noiseImage("reference", 128, 96, 1);
  report.scenes[0].series.resize(2);
  report.scenes[0].series[0].finalImage = noiseImage("pt", 128, 96, 2);
  report.scenes[0].series[0].errorMap = noiseImage("pt map", 128, 96, 3);  // the second series has no image
  const auto total = [&](const EmbeddedImages& images) {
    return images.uri(report.scenes[0].reference).size() + images.uri(report.scenes[0].series[0].finalImage).size() +
           images.uri(report.scenes[0].series[0].errorMap).size();
  };
  const EmbeddedImages ample(report, 10'000'000), tight(report, 90'000), tighter(report, 20'000), hopeless(report, 10);
  EXPECT_EQ(ample.coding(), ImageCoding{});
  EXPECT_EQ(ample.uri(report.scenes[0].reference).find("data:image/png;base64,"), 0U);
  EXPECT_EQ(ample.remark(), "");
  EXPECT_GT(tight.coding().jpegQuality, 0);
  EXPECT_EQ(tight.uri(report.scenes[0].reference).find("data:image/jpeg;base64,"), 0U);
  EXPECT_LE(total(tight), 90'000U);
  EXPECT_NE(tight.remark().find("JPEG of quality"), std::string::npos);
  EXPECT_GT(tighter.coding().reduction, 1U);
  EXPECT_LE(total(tighter), 20'000U);
  EXPECT_GT(total(hopeless), 10U) << "pictures are never left out";
}

}  // namespace
}  // namespace wavecrest
