// The verdict on an image, by what is committed: a hash of this build, of another build, a picture, or nothing.
#include "bench/score/image_verdict.h"

#include <gtest/gtest.h>

namespace wavecrest {
namespace {

const ScoreEntry kSmallEntry{.scene = "cornell-diffuse",
                             .method = Method::pt,
                             .width = kPictureWidth,
                             .height = kPictureHeight,
                             .iterations = 8};
constexpr Isa kIsa = Isa::avx2;

// Stripes, as SSIM of a constant image says little.
Image stripes(float brightness) {
  Image image{.width = kPictureWidth, .height = kPictureHeight, .channels = 3, .pixels = {}};
  for (uint32_t i = 0; i < 3 * kPictureWidth * kPictureHeight; ++i) {
    image.pixels.push_back(brightness * (i / 3 % 5 < 2 ? 0.2f : 0.6f));
  }
  return image;
}

ExpectedImages expectedOf(const Image& image, const std::string& build) {
  ExpectedImages expected;
  expected.hashes.set(ScoreSize::small, hashGroup(kIsa), kSmallEntry, hashImage(image.pixels));
  if (!build.empty()) expected.hashes.setBuild(ScoreSize::small, hashGroup(kIsa), build);
  expected.pictures.set(ScoreSize::small, kSmallEntry, pictureOf(image));
  return expected;
}

ImageVerdict judge(const Image& image, const ExpectedImages& expected, Isa isa = kIsa) {
  return judgeImage(image, ScoreSize::small, isa, kSmallEntry, expected, "this build");
}

TEST(ImageVerdict, isExactWhereTheBitsAreKnown) {
  for (const char* build : {"this build", "another build", ""}) {
    const ImageVerdict verdict = judge(stripes(1), expectedOf(stripes(1), build));
    EXPECT_EQ(verdict.text, "exact");
    EXPECT_TRUE(verdict.isAccepted());
    EXPECT_FALSE(verdict.difference);
  }
}

// However similar the picture is: the hash is known to be this build's.
TEST(ImageVerdict, refusesOtherBitsOfTheSameBuild) {
  for (const char* build : {"this build", ""}) {
    const ImageVerdict verdict = judge(stripes(1.00001f), expectedOf(stripes(1), build));
    EXPECT_EQ(verdict.validity, Validity::refused);
    EXPECT_EQ(verdict.text, "refused (other bits than those that are known of this build)");
    EXPECT_FALSE(verdict.isAccepted());
  }
}

TEST(ImageVerdict, comparesPicturesOfOtherBuilds) {
  const ExpectedImages expected = expectedOf(stripes(1), "another build");
  const ImageVerdict near = judge(stripes(1.001f), expected);
  EXPECT_EQ(near.validity, Validity::tolerated);
  EXPECT_TRUE(near.isAccepted());
  EXPECT_EQ(near.text.find("within tolerance (worst block: SSIM "), 0U) << near.text;
  EXPECT_NE(near.text.find("; image: SSIM 0.9999, mean off by 0.1 %)"), std::string::npos) << near.text;
  const ImageVerdict bright = judge(stripes(1.05f), expected);
  EXPECT_EQ(bright.text, "refused (image: mean off by 5 %, at most 0.3 %)");
  EXPECT_FALSE(bright.isAccepted());
  EXPECT_NEAR(bright.difference->meanOff, 0.05, 1e-6);
}

TEST(ImageVerdict, comparesPicturesOfOtherInstructionSets) {
  const ExpectedImages expected = expectedOf(stripes(1), "this build");
  EXPECT_EQ(judge(stripes(1), expected, Isa::sse4).validity, Validity::tolerated);
  EXPECT_EQ(judge(stripes(1.05f), expected, Isa::sse4).validity, Validity::refused);
}

TEST(ImageVerdict, isUnknownWithoutBitsAndPicture) {
  const ImageVerdict verdict = judge(stripes(1), {});
  EXPECT_EQ(verdict.text, "unknown (no picture of it is known)");
  EXPECT_FALSE(verdict.isAccepted());
}

}  // namespace
}  // namespace wavecrest
