#include "metrics/image/image_io.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <gtest/gtest.h>
#include <half.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include "metrics/image/atomic_file.h"
#include "metrics/image/srgb.h"
#include "tests/metrics/golden.h"
#include "tests/metrics/temporary_folder.h"

namespace wavecrest {
namespace {

class ImageFiles : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return files_.path(name); }
  void writeText(const std::string& name, const std::string& bytes) const { files_.write(name, bytes); }
  // What reading the file complains about; empty when it succeeds.
  std::string complaint(const std::string& name) const {
    try {
      readImage(path(name));
      return {};
    } catch (const ImageError& error) {
      return error.what();
    }
  }

  test::TemporaryFolder files_;
};

Image testImage(uint32_t channels = 3) {
  Image image{5, 3, channels, {}};
  for (uint32_t i = 0; i < 15 * channels; ++i) image.pixels.push_back(static_cast<float>(i) * 1.25f - 3);
  image.pixels[2] = 1e30f;
  image.pixels[3] = 1e-30f;
  return image;
}

TEST(Extension, isInLowerCaseAndOfTheFileAlone) {
  EXPECT_EQ(extensionOf("a/b.PnG"), ".png");
  EXPECT_EQ(extensionOf(".png"), ".png");
  EXPECT_EQ(extensionOf("a.exr/b"), "");
}

TEST_F(ImageFiles, ExrKeepsEveryBitAndTheMetadata) {
  const Image image = testImage();
  writeExr(path("a.exr"), image, {{"scene", "cornell"}, {"method", "vcm"}});
  const ImageFile file = readImage(path("a.exr"));
  EXPECT_EQ(file.image.width, 5u);
  EXPECT_EQ(file.image.height, 3u);
  EXPECT_EQ(file.image.pixels, image.pixels);
  EXPECT_EQ(file.encoding, Encoding::linear);
  EXPECT_EQ(file.metadata.at("scene"), "cornell");
  EXPECT_EQ(file.metadata.at("method"), "vcm");
}

TEST_F(ImageFiles, ExrLayersAreReadByName) {
  const Image image = testImage();
  Image variance = image;
  for (float& v : variance.pixels) v *= 2;
  const std::vector<ExrLayer> layers{{"variance", variance}};
  writeExr(path("a.exr"), image, {}, layers);
  EXPECT_EQ(readExrLayer(path("a.exr"), "variance").pixels, variance.pixels);
  EXPECT_EQ(readExrLayer(path("a.exr"), "").pixels, image.pixels);
  EXPECT_THROW(readExrLayer(path("a.exr"), "depth"), ImageError);
}

TEST_F(ImageFiles, PfmKeepsEveryBit) {
  const Image image = testImage();
  writePfm(path("a.pfm"), image);
  EXPECT_EQ(readImage(path("a.pfm")).image.pixels, image.pixels);
}

TEST_F(ImageFiles, GreyImagesComeBackWithThreeEqualChannels) {
  const Image grey = testImage(1);
  for (const char* name : {"a.exr", "a.pfm"}) {
    writeImage(path(name), grey);
    const Image back = readImage(path(name)).image;
    ASSERT_EQ(back.pixels.size(), 45u);
    for (size_t i = 0; i < 45; ++i) EXPECT_EQ(back.pixels[i], grey.pixels[i / 3]);
  }
}

TEST_F(ImageFiles, BigEndianPfmIsRead) {
  writeText("a.pfm", std::string("PF\n1 1\n1.0\n") + std::string("\x3f\x80\0\0\x40\0\0\0\xc0\x40\0\0", 12));
  EXPECT_EQ(readImage(path("a.pfm")).image.pixels, (std::vector<float>{1, 2, -3}));
}

TEST_F(ImageFiles, LinesOfAPfmMayEndWithCrLf) {
  const std::string numbers("\x3f\x80\0\0\x40\0\0\0\xc0\x40\0\0", 12);
  writeText("a.pfm", "PF\r\n1 1\r\n1.0\r\n" + numbers);
  EXPECT_EQ(readImage(path("a.pfm")).image.pixels, (std::vector<float>{1, 2, -3}));
}

TEST_F(ImageFiles, ScaleOfAPfmIsAFactor) {
  writeText("a.pfm", std::string("PF\n1 1\n2.5\n") + std::string("\x3f\x80\0\0\x40\0\0\0\xc0\x40\0\0", 12));
  EXPECT_EQ(readImage(path("a.pfm")).image.pixels, (std::vector<float>{2.5f, 5, -7.5f}));
}

TEST_F(ImageFiles, PngKeepsEveryCode) {
  const Image8 image = test::patternImage(31, 9);
  writePng(path("a.png"), image);
  const ImageFile file = readImage(path("a.png"));
  EXPECT_EQ(file.encoding, Encoding::srgb8);
  EXPECT_EQ(test::codesOf(file.image).pixels, image.pixels);
}

// libpng's own limit is 1,000,000 pixels a side.
TEST(Png, LongRowsAreWritten) {
  constexpr uint32_t kLongRow = 1'000'001;
  const std::vector<uint8_t> row(size_t{3} * kLongRow);
  EXPECT_NO_THROW(encodePng("row.png", kLongRow, 1, row.data()));
}

// Two pixels of a palette of red and azure, each with an alpha value (chunk tRNS).
TEST_F(ImageFiles, APngWithAPaletteAndAlphaIsRead) {
  const unsigned char bytes[] = {
      0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00,
      0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x01, 0x08, 0x03, 0x00, 0x00, 0x00, 0xc3, 0xfc, 0x8f, 0xb8, 0x00,
      0x00, 0x00, 0x06, 0x50, 0x4c, 0x54, 0x45, 0xff, 0x00, 0x00, 0x00, 0x80, 0xff, 0x57, 0x22, 0x65, 0xc5,
      0x00, 0x00, 0x00, 0x02, 0x74, 0x52, 0x4e, 0x53, 0x0a, 0xc8, 0x19, 0xc3, 0x6f, 0x30, 0x00, 0x00, 0x00,
      0x0b, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0x60, 0x64, 0x00, 0x00, 0x00, 0x05, 0x00, 0x02, 0xd1,
      0x66, 0x33, 0x78, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
  writeText("a.png", std::string(std::begin(bytes), std::end(bytes)));
  EXPECT_EQ(test::codesOf(readImage(path("a.png")).image).pixels, (std::vector<uint8_t>{0, 128, 255, 255, 0, 0}));
}

TEST_F(ImageFiles, RadianceRunLengthAndPlainPixelsAreRead) {
  const std::string head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
  // 9 wide, new encoding: red is a run of 128, green counts up, blue a run of 0, exponent a run of 129 (factor 2^-7).
  std::string line = std::string("\2\2\0\11", 4) + "\x89\x80" + std::string("\11\0\1\2\3\4\5\6\7\10", 10) +
                     std::string("\x89\0", 2) + "\x89\x81";
  writeText("a.hdr", head + "-Y 1 +X 9\n" + line);
  const Image image = readImage(path("a.hdr")).image;
  for (size_t x = 0; x < 9; ++x) {
    EXPECT_EQ(image.pixels[3 * x], 1.0f);
    EXPECT_EQ(image.pixels[3 * x + 1], static_cast<float>(x) / 128);
    EXPECT_EQ(image.pixels[3 * x + 2], 0.0f);
  }
  // 3 wide, plain, with an old-style run: pixel, (1 1 1 2).
  writeText("b.hdr", head + "EXPOSURE=2\n" + "-Y 1 +X 3\n");
  EXPECT_NE(complaint("b.hdr"), "") << "the blank line must end the header";
  writeText("b.hdr", "#?RGBE\nEXPOSURE=2\n\n-Y 1 +X 3\n" + std::string("\x80\x40\0\x82\1\1\1\2", 8));
  EXPECT_EQ(readImage(path("b.hdr")).image.pixels, (std::vector<float>{1, .5, 0, 1, .5, 0, 1, .5, 0}));
}

TEST_F(ImageFiles, OldRadianceRunsAreDigitsOfBase256) {
  const auto write = [&](const std::string& runs) {
    writeText("a.hdr", "#?RGBE\n\n-Y 1 +X 257\n" + std::string("\x80\x40\0\x81", 4) + runs);
  };
  write(std::string("\1\1\1\0\1\1\1\1", 8));  // 0 + 1 * 256
  const std::vector<float> pixels = readImage(path("a.hdr")).image.pixels;
  ASSERT_EQ(pixels.size(), size_t{3} * 257);
  for (size_t x = 0; x < 257; ++x) {
    EXPECT_EQ(pixels[3 * x], 1) << x;
    EXPECT_EQ(pixels[3 * x + 1], 0.5f) << x;
    EXPECT_EQ(pixels[3 * x + 2], 0) << x;
  }
  const std::string zeros("\1\1\1\0\1\1\1\0\1\1\1\0\1\1\1\0", 16);
  write(zeros + std::string("\1\1\1\1", 4));
  EXPECT_NE(complaint("a.hdr").find("a run passes the end"), std::string::npos) << "a count has four digits at most";
}

TEST_F(ImageFiles, RadianceColourCorrectionIsDividedOutAndOtherPrimariesAreRefused) {
  const auto write = [&](const std::string& lines) {
    writeText("a.hdr", "#?RGBE\n" + lines + "\n-Y 1 +X 1\n" + std::string("\x80\x40\x20\x82", 4));
  };
  write("");
  EXPECT_EQ(readImage(path("a.hdr")).image.pixels, (std::vector<float>{2, 1, .5}));
  write("COLORCORR=2 1 0.5\nEXPOSURE=2\nCOLORCORR=1 4 1\n");
  EXPECT_EQ(readImage(path("a.hdr")).image.pixels, (std::vector<float>{.5, .125, .5}));
  write("COLORCORR=2 1\n");
  EXPECT_NE(complaint("a.hdr").find("exposure"), std::string::npos) << complaint("a.hdr");
  for (const char* usual : {"0.640 0.330 0.290 0.600 0.150 0.060 0.333 0.333", ".64 .33 .3 .6 .15 .06 .3127 .329"}) {
    write(std::string("PRIMARIES= ") + usual + "\n");
    EXPECT_EQ(complaint("a.hdr"), "");
  }
  write("PRIMARIES=.708 .292 .17 .797 .131 .046 .3127 .329\n");  // Rec. 2020
  EXPECT_NE(complaint("a.hdr").find("primaries '.708 .292"), std::string::npos) << complaint("a.hdr");
}

TEST_F(ImageFiles, BadFilesAreNamedWithWhatIsWrong) {
  writeText("empty.exr", "");
  writeText("text.png", "hello");
  writeText("short.pfm", "PF\n100 100\n-1\nabc");
  writeText("zero.pfm", "PF\n0 5\n-1\n");
  writeText("huge.pfm", "PF\n4000000000 4000000000\n-1\n");
  writeText("size.pfm", "PF\n-3 5\n-1\n");
  writeText("scale.pfm", "PF\n1 1\n0\nabcdefghijkl");
  writeText("huge.hdr", "#?RADIANCE\n\n-Y 100000 +X 1000\n");
  writeText("black.hdr", "#?RGBE\nEXPOSURE=0\n\n-Y 1 +X 1\n" + std::string("\x40\x20\0\x82", 4));
  writeText("a.tif", "x");
  const std::pair<const char*, const char*> expected[] = {
      {"empty.exr", "OpenEXR"},   {"text.png", "PNG"},     {"short.pfm", "ends before"}, {"zero.pfm", "empty image"},
      {"huge.pfm", "at most"},    {"size.pfm", "'-3'"},    {"scale.pfm", "'0'"},         {"huge.hdr", "ends before"},
      {"a.tif", "unknown image"}, {"none.exr", "No such"}, {"black.hdr", "exposure"},
  };
  for (const auto& [name, text] : expected) {
    const std::string message = complaint(name);
    EXPECT_NE(message.find(text), std::string::npos) << name << " gave: " << message;
    EXPECT_EQ(message.find(path(name) + ": "), 0u) << "does not start with the file name: " << message;
    EXPECT_NE(message.find("; expected"), std::string::npos) << "does not say what was expected: " << message;
  }
}

TEST_F(ImageFiles, WritingLeavesNoTemporaryFilesAndReportsUnwritablePlaces) {
  writeImage(path("a.exr"), testImage());
  writeImage(path("a.exr"), testImage());
  writeImage(path("a.png"), testImage());
  size_t files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(files_.folder())) ++files;
  EXPECT_EQ(files, 2u);
  EXPECT_THROW(writeImage(path("missing/a.exr"), testImage()), ImageError);
  EXPECT_THROW(writeImage(path("a.tiff"), testImage()), ImageError);
}

// High enough for several reports, whatever the number of threads that compress.
Image tallImage() {
  Image image{3, 40000, 3, {}};
  for (size_t i = 0; i < image.pixelCount() * 3; ++i) image.pixels.push_back(std::sin(static_cast<float>(i)));
  return image;
}

TEST_F(ImageFiles, WritingAnExrTellsHowFarItIs) {
  const Image image = tallImage();
  std::vector<double> told;
  writeImage(path("a.exr"), image, {{"key", "value"}}, [&](double fraction) { told.push_back(fraction); });
  ASSERT_GT(told.size(), 2u);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_GT(told.front(), 0);
  EXPECT_EQ(told.back(), 1);
  const ImageFile read = readImage(path("a.exr"));
  EXPECT_EQ(read.image.pixels, image.pixels);
  EXPECT_EQ(read.metadata.at("key"), "value");
}

// A pipe takes bytes in order only, and an EXR is finished by what stands in its middle.
TEST_F(ImageFiles, AnExrGoesThroughAPipe) {
  ASSERT_EQ(mkfifo(path("pipe.exr").c_str(), 0600), 0);
  const Image image = tallImage();
  std::vector<unsigned char> received;
  std::thread reader([&] {
    std::ifstream pipe(path("pipe.exr"), std::ios::binary);
    received.assign(std::istreambuf_iterator<char>(pipe), {});
  });
  writeExr(path("pipe.exr"), image);
  reader.join();
  writeFileAtomically(path("copy.exr"), received);
  EXPECT_EQ(readImage(path("copy.exr")).image.pixels, image.pixels);
}

TEST_F(ImageFiles, AnExrForWhichThereIsNoRoomIsAnError) {
  EXPECT_THROW(writeExr("/dev/full", tallImage()), ImageError);
}

// Decoded sizes, by files that need not hold their pixels: the size is checked before them.
TEST_F(ImageFiles, WhatSmallFilesUnpackToIsBounded) {
  EXPECT_NO_THROW(checkDecodedSize("a.png", 16384, 8192, 1000));
  EXPECT_THROW(checkDecodedSize("a.png", 16384, 16384, 1000), ImageError);
  // Files that are as large as their pixels are always read.
  EXPECT_NO_THROW(checkDecodedSize("a.pfm", 16384, 16384, size_t{3} << 30));
  setenv(kImageLimitVariable, "4G", 1);
  EXPECT_NO_THROW(checkDecodedSize("a.png", 16384, 16384, 1000));
  setenv(kImageLimitVariable, "48K", 1);
  EXPECT_NO_THROW(checkDecodedSize("a.png", 64, 64, 1000));
  EXPECT_THROW(checkDecodedSize("a.png", 65, 64, 1000), ImageError);
  for (const char* wrong : {"many", "4GB", "-1", "0", "99999999999T"}) {
    setenv(kImageLimitVariable, wrong, 1);
    EXPECT_THROW(checkDecodedSize("a.png", 1, 1, 1000), ImageError) << wrong;
  }
  unsetenv(kImageLimitVariable);
}

// A black file of half floats under DWAB, which takes about 1/8000 of its samples.
TEST_F(ImageFiles, AnExrOfTheDensestCompressionIsRead) {
  constexpr int kSide = 2048;
  constexpr size_t kSamples = size_t{kSide} * kSide;
  {
    std::vector<Imath::half> samples(kSamples, Imath::half(0.0f));
    Imf::Header header(kSide, kSide);
    header.compression() = Imf::DWAB_COMPRESSION;
    Imf::FrameBuffer frame;
    for (const char* name : {"R", "G", "B"}) {
      header.channels().insert(name, Imf::Channel(Imf::HALF));
      frame.insert(name, Imf::Slice(Imf::HALF, reinterpret_cast<char*>(samples.data()), sizeof(Imath::half),
                                    sizeof(Imath::half) * kSide));
    }
    Imf::OutputFile file(path("a.exr").c_str(), header);
    file.setFrameBuffer(frame);
    file.writePixels(kSide);
  }
  ASSERT_LT(std::filesystem::file_size(path("a.exr")), 3 * sizeof(Imath::half) * kSamples / 4096);
  const std::vector<float> pixels = readImage(path("a.exr")).image.pixels;
  EXPECT_EQ(pixels.size(), 3 * kSamples);
  EXPECT_TRUE(std::all_of(pixels.begin(), pixels.end(), [](float value) { return value == 0; }));
}

TEST_F(ImageFiles, ExrAttributesLargerThanTheFileAreRefused) {
  writeExr(path("a.exr"), testImage(), {{"comment", "twelve bytes"}});
  std::ifstream in(path("a.exr"), std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(in), {}};
  const size_t value = bytes.find("twelve bytes");
  ASSERT_NE(value, std::string::npos);
  bytes.replace(value - 4, 4, std::string("\x00\x00\x00\x6e", 4));  // 1.8 GB
  writeText("large.exr", bytes);
  EXPECT_NE(complaint("large.exr").find("an attribute of 1845493760 bytes"), std::string::npos);
}

TEST(Srgb, CodeIsTheRoundedCurveAtEveryThreshold) {
  const auto exact = [](float v) {
    return static_cast<int>(std::lround(255 * srgbEncode(std::clamp(double{v}, 0.0, 1.0))));
  };
  for (int c = 1; c < 256; ++c) {
    float v = static_cast<float>(srgbDecode((c - 0.5) / 255));
    for (int step = 0; step < 8; ++step) v = std::nextafter(v, 0.0f);
    for (int step = 0; step < 16; ++step, v = std::nextafter(v, 2.0f)) {
      // The curve's two directions meet their published constants only to 1e-7: allow either code at the threshold.
      if (std::abs(255 * srgbEncode(double{v}) - c + 0.5) < 1e-4) continue;
      EXPECT_EQ(srgbCode(v), exact(v)) << v;
    }
  }
  for (int i = -10; i < 20000; ++i) {
    const float v = static_cast<float>(i) / 17321;
    EXPECT_EQ(srgbCode(v), exact(v)) << v;
  }
  EXPECT_EQ(srgbCode(std::nanf("")), 0);
  EXPECT_EQ(srgbCode(INFINITY), 255);
}

TEST(Srgb, ExposureScalesLinearLight) {
  const Image image{1, 1, 3, {0.1f, 0.2f, 0.4f}};
  EXPECT_EQ(encodeSrgb8(image, 1).pixels, (std::vector<uint8_t>{srgbCode(0.2f), srgbCode(0.4f), srgbCode(0.8f)}));
}

}  // namespace
}  // namespace wavecrest
