// Colours of OpenEXR files: primaries of their own, XYZ, and luminance with chroma, all read as linear Rec. 709.
#include <ImathBox.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "metrics/image/image_io.h"
#include "tests/metrics/temporary_folder.h"

namespace wavecrest {
namespace {

constexpr uint32_t kWidth = 6, kHeight = 4;

// A channel of a file: its value at a pixel, and the distance of its samples.
struct TestChannel {
  std::string name;
  float (*at)(int x, int y);
  int sampling = 1;
};

class ExrColours : public ::testing::Test {
 protected:
  // Writes the channels and reads them back.
  Image read(const std::vector<TestChannel>& channels, const Imf::Chromaticities* primaries = nullptr,
             int left = 0) const {
    const std::string path = files_.path("colours.exr");
    const Imath::Box2i window({left, 0}, {left + static_cast<int>(kWidth) - 1, static_cast<int>(kHeight) - 1});
    Imf::Header header(window, window);
    if (primaries != nullptr) Imf::addChromaticities(header, *primaries);
    std::vector<std::vector<float>> samples(channels.size());
    Imf::FrameBuffer frame;
    for (size_t c = 0; c < channels.size(); ++c) {
      const int step = channels[c].sampling;
      for (int y = 0; y < static_cast<int>(kHeight); y += step) {
        for (int x = 0; x < static_cast<int>(kWidth); x += step) samples[c].push_back(channels[c].at(x, y));
      }
      header.channels().insert(channels[c].name, Imf::Channel(Imf::FLOAT, step, step));
      const size_t stride = sizeof(float), row = stride * (kWidth / static_cast<uint32_t>(step));
      frame.insert(channels[c].name, Imf::Slice::Make(Imf::FLOAT, samples[c].data(), window.min, int64_t{kWidth},
                                                      int64_t{kHeight}, stride, row, step, step));
    }
    {
      Imf::OutputFile file(path.c_str(), header);
      file.setFrameBuffer(frame);
      file.writePixels(kHeight);
    }
    const ImageFile file = readImage(path);
    EXPECT_EQ(file.corner[0], left);
    return file.image;
  }

  test::TemporaryFolder files_;
};

constexpr auto kZero = [](int, int) { return 0.0f; };
constexpr auto kOne = [](int, int) { return 1.0f; };

// XYZ of linear Rec. 709 (IEC 61966-2-1).
std::array<double, 3> xyzOf(const float* rgb) {
  constexpr double kMatrix[3][3] = {{0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}};
  std::array<double, 3> xyz{};
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) xyz[i] += kMatrix[i][j] * double{rgb[j]};
  }
  return xyz;
}

constexpr double kDigits = 1e-3;  // of the matrix above

// The chromaticity of the first pixel must be (x, y).
void expectChromaticity(const Image& image, const Imath::V2f& expected) {
  const auto [x, y, z] = xyzOf(image.pixels.data());
  EXPECT_NEAR(x / (x + y + z), double{expected.x}, kDigits);
  EXPECT_NEAR(y / (x + y + z), double{expected.y}, kDigits);
}

// ACEScg's.
const Imf::Chromaticities kAp1({0.713f, 0.293f}, {0.165f, 0.830f}, {0.128f, 0.044f}, {0.32168f, 0.33767f});

TEST_F(ExrColours, PrimariesAndWhiteAreThoseOfTheHeader) {
  expectChromaticity(read({{"R", kOne}, {"G", kZero}, {"B", kZero}}, &kAp1), kAp1.red);
  expectChromaticity(read({{"R", kZero}, {"G", kOne}, {"B", kZero}}, &kAp1), kAp1.green);
  expectChromaticity(read({{"R", kZero}, {"G", kZero}, {"B", kOne}}, &kAp1), kAp1.blue);
  const Image white = read({{"R", kOne}, {"G", kOne}, {"B", kOne}}, &kAp1);
  expectChromaticity(white, kAp1.white);
  EXPECT_NEAR(xyzOf(white.pixels.data())[1], 1, kDigits);
}

TEST_F(ExrColours, Rec709InTheHeaderChangesNoBit) {
  const Imf::Chromaticities rec709({0.64f, 0.33f}, {0.3f, 0.6f}, {0.15f, 0.06f}, {0.3127f, 0.329f});
  const std::vector<TestChannel> channels = {{"R", [](int x, int) { return 0.1f * static_cast<float>(x); }},
                                             {"G", [](int, int y) { return 0.3f * static_cast<float>(y); }},
                                             {"B", kOne}};
  EXPECT_EQ(read(channels, &rec709).pixels, read(channels).pixels);
}

TEST_F(ExrColours, XyzIsConverted) {
  const Image image = read({{"X", [](int, int) { return 0.3f; }},
                            {"Y", [](int, int) { return 0.4f; }},
                            {"Z", [](int, int) { return 0.2f; }}});
  const auto [x, y, z] = xyzOf(image.pixels.data());
  EXPECT_NEAR(x, 0.3, kDigits);
  EXPECT_NEAR(y, 0.4, kDigits);
  EXPECT_NEAR(z, 0.2, kDigits);
}

TEST_F(ExrColours, LuminanceAloneIsGrey) {
  const Image image = read({{"Y", [](int x, int) { return static_cast<float>(x); }}}, &kAp1);
  EXPECT_EQ(image.pixels[3], 1);
  EXPECT_EQ(image.pixels[4], 1);
  EXPECT_EQ(image.pixels[5], 1);
}

// Red, green and blue of the file that the luminance and the chroma below are made of. Chroma is a linear function of
// the place, so that what is between its samples is known.
float redShare(int x, int) { return 0.2f + 0.1f * static_cast<float>(x); }
float blueShare(int, int y) { return 0.5f - 0.1f * static_cast<float>(y); }
float light(int x, int y) { return 1 + static_cast<float>(x * y); }

TEST_F(ExrColours, LuminanceWithChromaIsColour) {
  for (const int sampling : {1, 2}) {
    for (const int left : {0, -2}) {  // windows begin at multiples of the distance of samples
      const Image image = read({{"Y", light},
                                {"RY", [](int x, int y) { return redShare(x, y) - 1; }, sampling},
                                {"BY", [](int x, int y) { return blueShare(x, y) - 1; }, sampling}},
                               nullptr, left);
      for (int y = 0; y < static_cast<int>(kHeight) - 1; ++y) {
        for (int x = 0; x < static_cast<int>(kWidth) - 1; ++x) {
          const float* const pixel = &image.pixels[3 * (static_cast<size_t>(y) * kWidth + static_cast<size_t>(x))];
          const double luminance = double{light(x, y)}, red = luminance * double{redShare(x, y)};
          EXPECT_NEAR(double{pixel[0]}, red, 1e-5 * luminance) << x << ", " << y;
          EXPECT_NEAR(double{pixel[2]}, luminance * double{blueShare(x, y)}, 1e-5 * luminance) << x << ", " << y;
          EXPECT_NEAR(xyzOf(pixel)[1], luminance, kDigits * luminance) << x << ", " << y;
        }
      }
    }
  }
}

TEST_F(ExrColours, PrimariesWithoutAnAreaAreRefused) {
  const Imf::Chromaticities flat({0.3f, 0.3f}, {0.3f, 0.3f}, {0.3f, 0.3f}, {0.3f, 0.3f});
  EXPECT_THROW(read({{"R", kOne}, {"G", kOne}, {"B", kOne}}, &flat), ImageError);
}

}  // namespace
}  // namespace wavecrest
