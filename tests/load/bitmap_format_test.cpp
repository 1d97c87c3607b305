// Bitmaps of each layout of BMP, TGA and JPEG files, and damaged ones.
#include <cmath>
#include <cstdlib>

#include "metrics/image/image_io.h"
#include "tests/load/bitmap_scene.h"
#include "tests/load/mesh_text.h"

namespace wavecrest {
namespace {

std::string withByte(std::string bytes, size_t at, int value) {
  bytes[at] = static_cast<char>(value);
  return bytes;
}

// Two pixels, red over blue, as files of each layout. Rows of a BMP fill four bytes.
std::string bmpOf(bool palette, bool topFirst) {
  std::string bytes = "BM";
  const auto word = [&](uint32_t value) { appendValue<uint32_t>(bytes, value, false); };
  for (const uint32_t value : {70u, 0u, palette ? 62u : 54u, 40u, 1u}) word(value);
  word(topFirst ? static_cast<uint32_t>(-2) : 2u);
  appendValue<uint16_t>(bytes, 1, false);
  appendValue<uint16_t>(bytes, palette ? 8 : 24, false);
  for (const uint32_t value : {0u, 8u, 0u, 0u, 2u, 0u}) word(value);
  const std::string red("\0\0\xff\0", 4), blue("\xff\0\0\0", 4);
  if (palette) return bytes + red + blue + std::string(topFirst ? "\0\0\0\0\1\0\0\0" : "\1\0\0\0\0\0\0\0", 8);
  return bytes + (topFirst ? red + blue : blue + red);
}
// One pixel in a row of four bytes. masks: of red, green and blue, in a V5 header. Without masks the header has 40
// bytes.
std::string bmpOfPixel(uint16_t bits, std::string_view row, const std::vector<uint32_t>& masks = {}) {
  const uint32_t header = masks.empty() ? 40u : 124u;
  std::string bytes = "BM";
  const auto word = [&](uint32_t value) { appendValue<uint32_t>(bytes, value, false); };
  for (const uint32_t value : {14 + header + 4, 0u, 14 + header, header, 1u, 1u}) word(value);
  appendValue<uint16_t>(bytes, 1, false);
  appendValue<uint16_t>(bytes, bits, false);
  for (const uint32_t value : {masks.empty() ? 0u : 3u, 4u, 0u, 0u, 0u, 0u}) word(value);
  for (const uint32_t mask : masks) word(mask);
  bytes.resize(14 + header, '\0');
  return bytes + std::string(row);
}
std::string tgaOf(bool runs, bool topFirst) {
  std::string bytes(18, '\0');
  bytes[2] = runs ? 10 : 2;
  bytes[12] = 1;
  bytes[14] = 2;
  bytes[16] = 24;
  bytes[17] = topFirst ? 0x20 : 0;
  const std::string red("\0\0\xff", 3), blue("\xff\0\0", 3), packet(runs ? "\0" : "", runs ? 1 : 0);
  return bytes + packet + (topFirst ? red : blue) + packet + (topFirst ? blue : red);
}
const std::vector<float> kRedOverBlue = {1, 0, 0, 0, 0, 1};

// bytesOf: the two pixels as a file; its first argument is palette or runs, its second topFirst.
void expectRedOverBlue(const std::string& file, std::string (*bytesOf)(bool, bool)) {
  const Folder folder;
  for (const bool packed : {false, true}) {
    for (const bool topFirst : {false, true}) {
      folder.write(file, bytesOf(packed, topFirst));
      EXPECT_EQ(bitmapOf(folder, file).bitmap->pixels, kRedOverBlue) << file << packed << topFirst;
    }
  }
}

TEST(Bitmap, BmpOfEachLayout) { expectRedOverBlue("two.bmp", bmpOf); }

TEST(Bitmap, MasksOfABmpSayWhereItsChannelsAre) {
  const Folder folder;
  const std::string cases[] = {
      bmpOfPixel(32, {"\0\0\xff\x80", 4}),
      bmpOfPixel(32, {"\0\0\xff\x80", 4}, {0xff0000, 0xff00, 0xff}),
      bmpOfPixel(32, {"\x80\0\0\xff", 4}, {0xff000000, 0xff0000, 0xff00}),
      bmpOfPixel(24, {"\xff\0\0\0", 4}, {0xff, 0xff00, 0xff0000}),
  };
  for (const std::string& bytes : cases) {
    folder.write("red.bmp", bytes);
    EXPECT_EQ(bitmapOf(folder, "red.bmp").bitmap->pixels, (std::vector<float>{1, 0, 0})) << (&bytes - cases);
  }
}

TEST(Bitmap, MasksOfABmpThatAreNotWholeBytesAreErrors) {
  const Folder folder;
  const std::string cases[] = {
      bmpOfPixel(32, {"\0\0\0\0", 4}, {0x7c00, 0x3e0, 0x1f}),
      bmpOfPixel(32, {"\0\0\0\0", 4}, {0xff0, 0xff00, 0xff}),
      bmpOfPixel(32, {"\0\0\0\0", 4}, {0xff0000, 0xff00, 0}),
      bmpOfPixel(24, {"\0\0\0\0", 4}, {0xff000000, 0xff00, 0xff}),
      withByte(bmpOf(false, false), 30, 3),  // ends inside the masks
  };
  for (const std::string& bytes : cases) {
    folder.write("masks.bmp", bytes);
    expectTextureError(folder, R"(<string name="filename" value="masks.bmp"/>)", "masks are not whole bytes");
  }
}

TEST(Bitmap, TgaOfEachLayout) { expectRedOverBlue("two.tga", tgaOf); }

TEST(Bitmap, TgaRunRepeatsItsColour) {
  std::string bytes = tgaOf(true, true).substr(0, 18);
  bytes += "\x81";
  bytes += std::string("\0\0\xff", 3);
  const Folder folder;
  folder.write("run.tga", bytes);
  EXPECT_EQ(bitmapOf(folder, "run.tga").bitmap->pixels, (std::vector<float>{1, 0, 0, 1, 0, 0}));
}

TEST(Bitmap, ColoursOutsideOfRec709KeepTheirNegativeChannels) {
  const Folder folder;
  const auto write = [&](std::vector<float> pixels) {
    writeExr((folder.path() / "wide.exr").string(),
             {.width = 2, .height = 1, .channels = 3, .pixels = std::move(pixels)});
  };
  write({-0.1f, 0.5f, 0.5f, 0, 0, 0});
  EXPECT_EQ(bitmapOf(folder, "wide.exr").bitmap->pixels[0], -0.1f);
  write({0.1f, -0.5f, 0.1f, 0, 0, 0});
  expectTextureError(folder, R"(<string name="filename" value="wide.exr"/>)",
                     "reflectance texture has a value of -0.5");
}

TEST(Bitmap, WhatATgaUnpacksToIsBounded) {
  std::string bytes = tgaOf(true, true).substr(0, 18);
  bytes[12] = 64;
  bytes += "\xff" + std::string("\0\0\xff", 3);  // 64 x 2 pixels are 1536 bytes as floats
  const Folder folder;
  folder.write("run.tga", bytes);
  EXPECT_EQ(bitmapOf(folder, "run.tga").bitmap->width, 64u);
  setenv(kImageLimitVariable, "1K", 1);
  expectTextureError(folder, R"(<string name="filename" value="run.tga"/>)", "unpacks to 64x2 pixels");
  unsetenv(kImageLimitVariable);
}

TEST(Bitmap, DamagedBmpAndTgaAreErrors) {
  const Folder folder;
  const std::string bmp = bmpOf(false, false), tga = tgaOf(false, false);
  const std::pair<std::string, std::string> cases[] = {
      {"a.bmp", bmp.substr(0, 60)},     {"b.bmp", "BM"},
      {"c.bmp", withByte(bmp, 28, 16)}, {"d.tga", tga.substr(0, 22)},
      {"e.tga", withByte(tga, 2, 7)},   {"f.tga", withByte(tga, 15, 127)}};
  for (const auto& [name, bytes] : cases) {
    folder.write(name, bytes);
    expectTextureError(folder, R"(<string name="filename" value=")" + name + "\"/>", name);
  }
}

// ---- JPEG -----------------------------------------------------------------------------------------------------------

TEST(Bitmap, JpegIsDecodedFromSrgb) {
  const BitmapTexture texture = bitmapOf(Folder(), std::string(WAVECREST_TEST_DATA) + "/halves.jpg");
  const Bitmap& bitmap = *texture.bitmap;
  ASSERT_EQ(bitmap.width, 32u);
  ASSERT_EQ(bitmap.height, 16u);
  // Left half red, right half mid grey (code 128); JPEG is lossy, two codes either way.
  const float* left = &bitmap.pixels[3 * (8 * 32 + 4)];
  const float* right = &bitmap.pixels[3 * (8 * 32 + 28)];
  EXPECT_NEAR(left[0], 1, 0.02);
  EXPECT_NEAR(left[1], 0, 0.01);
  EXPECT_NEAR(right[0], 0.21586, 0.008);
  EXPECT_NEAR(right[2], 0.21586, 0.008);
}

std::string halvesJpeg() {
  std::ifstream in(std::string(WAVECREST_TEST_DATA) + "/halves.jpg", std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Bitmap, TruncatedJpegIsAnError) {
  const std::string bytes = halvesJpeg();
  ASSERT_GT(bytes.size(), 300u);
  const Folder folder;
  folder.write("half.jpg", bytes.substr(0, bytes.size() - 40));
  expectTextureError(folder, R"(<string name="filename" value="half.jpg"/>)", "damaged JPEG");
}

// The frame header begins with a marker of two bytes, its length, and the precision. Height, width, the number of
// components and three bytes for each of them follow.
TEST(Bitmap, WhatAJpegUnpacksToIsBounded) {
  std::string bytes = halvesJpeg();
  const size_t frame = bytes.find(std::string("\xff\xc0\0\x11", 4));
  ASSERT_NE(frame, std::string::npos);
  bytes.replace(frame + 5, 4, "\x4e\x20\x4e\x20");  // 20000 in two bytes, twice
  const Folder folder;
  folder.write("large.jpg", bytes);
  expectTextureError(folder, R"(<string name="filename" value="large.jpg"/>)", "announces 20000 x 20000 pixels");
  folder.write("large.jpg", bytes + std::string(400'000, '\0'));
  expectTextureError(folder, R"(<string name="filename" value="large.jpg"/>)", "unpacks to 20000x20000 pixels");
}

TEST(Bitmap, JpegInCmykIsAnError) {
  std::string bytes = halvesJpeg();
  const size_t frame = bytes.find(std::string("\xff\xc0\0\x11", 4));
  ASSERT_NE(frame, std::string::npos);
  bytes[frame + 3] = 8 + 4 * 3;
  bytes[frame + 9] = 4;
  bytes.insert(frame + 19, "\4\x11\1");
  const Folder folder;
  folder.write("cmyk.jpg", bytes);
  expectTextureError(folder, R"(<string name="filename" value="cmyk.jpg"/>)", "JPEG in CMYK; expected grey or RGB");
}

}  // namespace
}  // namespace wavecrest
