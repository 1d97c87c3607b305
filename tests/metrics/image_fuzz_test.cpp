// 5,000 damaged image files through `wavecrest compare`: each is either compared or refused, never anything else.
// Under the asan-ubsan preset this is also a memory test of the decoders.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <gtest/gtest.h>
#include <half.h>
#include <png.h>

#include <array>
#include <random>

#include "metrics/image/atomic_file.h"
#include "metrics/image/image_io.h"
#include "tests/metrics/compare_runner.h"
#include "tests/metrics/golden.h"
#include "tests/metrics/temporary_folder.h"

namespace wavecrest {
namespace {

constexpr uint32_t kWidth = 21, kHeight = 19;

Image sampleImage() { return test::toFloats(test::patternImage(kWidth, kHeight)); }

// Half floats, wavelet compression.
void writeHalfExr(const std::string& path) {
  std::vector<half> samples(kWidth * kHeight, half(0.25f));
  Imf::Header header(kWidth, kHeight);
  header.compression() = Imf::PIZ_COMPRESSION;
  Imf::FrameBuffer frame;
  for (const char* name : {"R", "G", "B"}) {
    header.channels().insert(name, Imf::Channel(Imf::HALF));
    frame.insert(name,
                 Imf::Slice(Imf::HALF, reinterpret_cast<char*>(samples.data()), sizeof(half), sizeof(half) * kWidth));
  }
  Imf::OutputFile file(path.c_str(), header);
  file.setFrameBuffer(frame);
  file.writePixels(kHeight);
}

void writeTiledExr(const std::string& path) {
  std::vector<float> samples(kWidth * kHeight, 0.5f);
  Imf::Header header(kWidth, kHeight);
  header.compression() = Imf::RLE_COMPRESSION;
  header.setTileDescription(Imf::TileDescription(8, 8));
  header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
  Imf::FrameBuffer frame;
  frame.insert("Y",
               Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(samples.data()), sizeof(float), sizeof(float) * kWidth));
  Imf::TiledOutputFile file(path.c_str(), header);
  file.setFrameBuffer(frame);
  file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
}

void writeDeepPng(const std::string& path) {
  std::vector<uint16_t> samples(kWidth * kHeight * 2, 30000);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = kWidth;
  image.height = kHeight;
  image.format = PNG_FORMAT_LINEAR_Y_ALPHA;
  ASSERT_NE(png_image_write_to_file(&image, path.c_str(), 0, samples.data(), 0, nullptr), 0);
}

std::string radianceBytes() {
  std::string bytes = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=1.5\n\n-Y 19 +X 21\n";
  for (uint32_t y = 0; y < kHeight; ++y) {
    bytes += std::string("\2\2\0", 3) + static_cast<char>(kWidth);
    for (int channel = 0; channel < 4; ++channel) {
      bytes += static_cast<char>(128 + 11);  // a run of 11, then 10 plain bytes
      bytes += static_cast<char>(100 + y);
      bytes += static_cast<char>(10);
      for (int i = 0; i < 10; ++i) bytes += static_cast<char>(120 + i);
    }
  }
  return bytes;
}

// One to eight changes: flipped bits, new bytes, a cut, a doubled or removed part, an extreme 32-bit number.
std::string damage(std::string bytes, std::mt19937& random) {
  const auto below = [&](size_t n) {
    return n == 0 ? size_t{0} : std::uniform_int_distribution<size_t>(0, n - 1)(random);
  };
  // Half of the damage goes to the header, where the decisions are.
  const auto position = [&] {
    return below(2) == 0 ? below(std::min<size_t>(bytes.size(), 400)) : below(bytes.size());
  };
  for (size_t change = 0, changes = 1 + below(8); change < changes && !bytes.empty(); ++change) {
    const size_t at = position();
    switch (below(6)) {
      case 0:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
        break;
      case 1:
        bytes[at] = static_cast<char>(below(256));
        break;
      case 2:
        if (below(4) == 0) bytes.resize(at);
        break;
      case 3:
        bytes.insert(at, bytes.substr(below(bytes.size()), below(64)));
        break;
      case 4:
        bytes.erase(at, below(16));
        break;
      default: {
        constexpr std::array<uint32_t, 6> kExtremes{0, 0xffffffff, 0x7fffffff, 0x80000000, 0x00ffffff, 0x10000};
        const uint32_t value = kExtremes[below(kExtremes.size())];
        for (size_t i = 0; i < 4 && at + i < bytes.size(); ++i)
          bytes[at + i] = static_cast<char>(value >> (below(2) ? 8 * i : 24 - 8 * i));
      }
    }
  }
  return bytes;
}

TEST(ImageFuzz, FiveThousandDamagedFilesAreComparedOrRefused) {
  const test::TemporaryFolder files;
  writeExr(files.path("zip.exr"), sampleImage(), {{"scene", "fuzz"}});
  writeHalfExr(files.path("half.exr"));
  writeTiledExr(files.path("tiled.exr"));
  writePng(files.path("rgb.png"), test::patternImage(kWidth, kHeight));
  writeDeepPng(files.path("deep.png"));
  writePfm(files.path("colour.pfm"), sampleImage());
  files.write("run.hdr", radianceBytes());
  const std::array<std::string, 7> names{"zip.exr",  "half.exr",   "tiled.exr", "rgb.png",
                                         "deep.png", "colour.pfm", "run.hdr"};
  std::array<int, 5> outcomes{};
  std::mt19937 random(20240611);
  for (int i = 0; i < 5000; ++i) {
    const std::string& name = names[static_cast<size_t>(i) % names.size()];
    const auto original = readFileBytes(files.path(name));
    if (static_cast<size_t>(i) < names.size()) {
      const auto run = test::runCompare({files.path("rgb.png"), files.path(name), "--metrics", "rmse,flip"});
      ASSERT_EQ(run.exitCode, kExitDone) << name << " undamaged: " << run.error;
    }
    files.write("damaged_" + name, damage(std::string(original.begin(), original.end()), random));
    const auto run = test::runCompare({files.path("rgb.png"), files.path("damaged_" + name), "--metrics", "rmse,flip"});
    ASSERT_TRUE(run.exitCode == kExitDone || run.exitCode == kExitInput) << name << " " << i << ": " << run.error;
    if (run.exitCode == kExitInput) {
      ASSERT_NE(run.error.find("; expected"), std::string::npos) << run.error;
    }
    ++outcomes[static_cast<size_t>(run.exitCode)];
  }
  // The test means something only if both ways are taken often.
  EXPECT_GT(outcomes[kExitDone], 300);
  EXPECT_GT(outcomes[kExitInput], 1000);
}

}  // namespace
}  // namespace wavecrest
