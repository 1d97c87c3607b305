// A reference file gives back the mean, the halves and how they were made.
#include "bench/campaign/reference_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <random>

#include "tests/metrics/temporary_folder.h"

namespace wavecrest {
namespace {

Image noise(uint32_t width, uint32_t height, float mean, float deviation, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal(mean, deviation);
  Image image{.width = width, .height = height, .channels = 3, .pixels = std::vector<float>(3 * width * height)};
  for (float& sample : image.pixels) sample = normal(random);
  return image;
}

Reference sampleReference() {
  Reference reference{
      .mean = noise(32, 24, 1, 0.3f, 1), .difference = noise(32, 24, 0, 0.01f, 2), .info = {}, .noiseFloors = {}};
  reference.info = {.scene = "box",
                    .sceneHash = "00ff",
                    .method = "vcm",
                    .sampler = "independent",
                    .precision = "float",
                    .seed = 7,
                    .maxDepth = 64,
                    .rouletteDepth = 5,
                    .radius = 1e-4,
                    .radiusAlpha = 0.75,
                    .methodReason = "merging alone makes some paths",
                    .iterations = 12,
                    .renderSeconds = 1.0 / 3,
                    .relativeError = 0.0123,
                    .version = "0.1",
                    .commit = "abc"};
  measureNoiseFloors(reference);
  return reference;
}

TEST(ReferenceFile, whatIsWrittenIsReadBack) {
  const test::TemporaryFolder folder;
  const Reference written = sampleReference();
  writeReference(folder.path("r.exr"), written);
  const Reference read = readReference(folder.path("r.exr"));
  EXPECT_EQ(read.mean.pixels, written.mean.pixels) << "the mean keeps every bit";
  ASSERT_TRUE(read.difference);
  for (size_t i = 0; i < read.difference->pixels.size(); ++i) {
    const float d = written.difference->pixels[i];
    ASSERT_NEAR(read.difference->pixels[i], d, std::fabs(d) * 0x1p-12f);
    ASSERT_FLOAT_EQ(read.halfA().pixels[i], read.mean.pixels[i] + read.difference->pixels[i]);
    ASSERT_FLOAT_EQ(read.halfB().pixels[i], read.mean.pixels[i] - read.difference->pixels[i]);
  }
  EXPECT_EQ(read.noiseFloors, written.noiseFloors);
  EXPECT_EQ(read.noiseFloors.count("q_mos"), 1u);
  const ReferenceInfo &a = read.info, &b = written.info;
  EXPECT_EQ(std::tie(a.scene, a.sceneHash, a.method, a.sampler, a.precision, a.seed, a.maxDepth, a.rouletteDepth),
            std::tie(b.scene, b.sceneHash, b.method, b.sampler, b.precision, b.seed, b.maxDepth, b.rouletteDepth));
  EXPECT_EQ(std::tie(a.radius, a.radiusAlpha, a.methodReason, a.iterations, a.renderSeconds, a.relativeError),
            std::tie(b.radius, b.radiusAlpha, b.methodReason, b.iterations, b.renderSeconds, b.relativeError));
  EXPECT_EQ(std::tie(a.version, a.commit), std::tie(b.version, b.commit));
}

TEST(ReferenceFile, holdsTheVarianceOfTheMean) {
  const test::TemporaryFolder folder;
  const Reference written = sampleReference();
  writeReference(folder.path("r.exr"), written);
  const Image variance = readExrLayer(folder.path("r.exr"), "variance");
  for (size_t i = 0; i < variance.pixels.size(); ++i) {
    const float d = written.difference->pixels[i];
    ASSERT_NEAR(variance.pixels[i], d * d, d * d * 0x1p-12f);
  }
}

TEST(ReferenceFile, aCompactOneMeasuresAsTheWholeOneDoes) {
  const test::TemporaryFolder folder;
  const Reference written = sampleReference();
  writeReference(folder.path("whole.exr"), written);
  writeCompactReference(folder.path("compact.exr"), written);
  const Reference read = readReference(folder.path("compact.exr"));
  EXPECT_TRUE(read.info.isCompact());
  EXPECT_FALSE(readReference(folder.path("whole.exr")).info.isCompact());
  EXPECT_EQ(whyNoReference(read), "");
  EXPECT_EQ(read.noiseFloors, written.noiseFloors) << "as measured before rounding";
  EXPECT_EQ(read.info.iterations, written.info.iterations);
  double square = 0, squareWritten = 0;
  for (size_t i = 0; i < read.mean.pixels.size(); ++i) {
    const float m = written.mean.pixels[i], d = written.difference->pixels[i];
    ASSERT_NEAR(read.mean.pixels[i], m, std::fabs(m) * 0x1p-9f);
    ASSERT_NEAR(read.difference->pixels[i], d, std::fabs(d) * 0x1p-2f);
    square += std::pow(double{read.difference->pixels[i]}, 2);
    squareWritten += std::pow(double{d}, 2);
  }
  // Rounding errors of up to a quarter cancel in the sum over 2304 samples, whose squares tell of the noise.
  EXPECT_NEAR(square, squareWritten, 0.02 * squareWritten);
  EXPECT_LT(std::filesystem::file_size(folder.path("compact.exr")),
            std::filesystem::file_size(folder.path("whole.exr")) / 3);
}

TEST(ReferenceFile, aCompactOneHoldsNothingAboveTheLargestHalf) {
  const test::TemporaryFolder folder;
  Reference bright = sampleReference();
  bright.mean.pixels[5] = 65408;  // the largest half of nine significant bits
  writeCompactReference(folder.path("r.exr"), bright);
  EXPECT_EQ(readReference(folder.path("r.exr")).mean.pixels[5], 65408);
  bright.mean.pixels[5] = 65505;
  EXPECT_THROW(writeCompactReference(folder.path("r.exr"), bright), ImageError);
}

TEST(ReferenceFile, relativeErrorIsThatOfTheDefinitionHoweverBrightTheSceneIs) {
  // Samples of one brightness with a half difference of a tenth of it.
  for (const float brightness : {1.0f, 1e-3f, 1e3f}) {
    const Image mean = noise(4, 4, brightness, 0, 1), difference = noise(4, 4, 0.1f * brightness, 0, 1);
    EXPECT_NEAR(relativeError(mean, difference), 0.1, 1e-6) << brightness;
  }
  EXPECT_EQ(relativeError(noise(4, 4, 0, 0, 1), noise(4, 4, 0, 0, 1)), 0) << "of a black image";
}

TEST(ReferenceFile, anyOtherExrIsAReferenceOfUnknownNoise) {
  const test::TemporaryFolder folder;
  writeExr(folder.path("plain.exr"), noise(4, 4, 1, 0.1f, 1));
  const Reference reference = readReference(folder.path("plain.exr"));
  EXPECT_FALSE(reference.difference);
  EXPECT_TRUE(reference.noiseFloors.empty());
  EXPECT_TRUE(reference.info.sceneHash.empty());
}

TEST(ReferenceFile, whatIsNoReferenceIsRefused) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(readReference(folder.path("none.exr")), ImageError);
  writePng(folder.path("codes.png"), noise(4, 4, 1, 0.1f, 1));
  EXPECT_THROW(readReference(folder.path("codes.png")), ImageError);
  writeExr(folder.path("number.exr"), noise(4, 4, 1, 0.1f, 1), {{"wavecrest:iterations", "many"}});
  EXPECT_THROW(readReference(folder.path("number.exr")), ImageError);
  writeExr(folder.path("layer.exr"), noise(4, 4, 1, 0.1f, 1),
           {{"wavecrest:iterations", "4"}, {"wavecrest:relative_error", "0.1"}});
  EXPECT_THROW(readReference(folder.path("layer.exr")), ImageError) << "halves are promised, but not there";
}

}  // namespace
}  // namespace wavecrest
