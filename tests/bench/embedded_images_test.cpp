#include "bench/report/png_embedding.h"

#include <gtest/gtest.h>
#include <png.h>

#include <stdexcept>
#include <string_view>

namespace wavecrest {
namespace {

std::string base64Of(std::string_view text) {
  return base64({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

// The reverse of base64, by looking digits up one at a time.
std::vector<uint8_t> decoded(std::string_view text) {
  const std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<uint8_t> bytes;
  uint32_t bits = 0;
  int count = 0;
  for (const char digit : text.substr(0, text.find('='))) {
    bits = (bits << 6) | static_cast<uint32_t>(alphabet.find(digit));
    count += 6;
    if (count >= 8) bytes.push_back(static_cast<uint8_t>(bits >> (count -= 8)));
  }
  return bytes;
}

TEST(Base64, testVectorsOfRfc4648) {
  EXPECT_EQ(base64Of(""), "");
  EXPECT_EQ(base64Of("f"), "Zg==");
  EXPECT_EQ(base64Of("fo"), "Zm8=");
  EXPECT_EQ(base64Of("foo"), "Zm9v");
  EXPECT_EQ(base64Of("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64Of("\xfb\xff"), "+/8=");
}

TEST(PngEmbedding, pixelsSurviveTheRoundTrip) {
  const ReportImage image{.label = "two by three",
                          .width = 2,
                          .height = 3,
                          .rgb = {0, 1, 2, 3, 4, 5, 255, 254, 253, 10, 20, 30, 100, 150, 200, 7, 8, 9}};
  const std::string uri = pngDataUri(image);
  const std::string_view prefix = "data:image/png;base64,";
  ASSERT_EQ(uri.substr(0, prefix.size()), prefix);
  const std::vector<uint8_t> bytes = decoded(std::string_view(uri).substr(prefix.size()));

  png_image header = {};
  header.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_memory(&header, bytes.data(), bytes.size()), 0) << header.message;
  EXPECT_EQ(header.width, 2U);
  EXPECT_EQ(header.height, 3U);
  header.format = PNG_FORMAT_RGB;
  std::vector<uint8_t> rgb(PNG_IMAGE_SIZE(header));
  ASSERT_NE(png_image_finish_read(&header, nullptr, rgb.data(), 0, nullptr), 0) << header.message;
  EXPECT_EQ(rgb, image.rgb);
}

TEST(PngEmbedding, refusesPixelsThatDoNotFitTheSize) {
  EXPECT_THROW(pngDataUri({.label = "short", .width = 2, .height = 2, .rgb = {1, 2, 3}}), std::invalid_argument);
  EXPECT_THROW(pngDataUri({.label = "empty", .width = 0, .height = 0, .rgb = {}}), std::invalid_argument);
}

}  // namespace
}  // namespace wavecrest
