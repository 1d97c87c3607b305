// What a scene renders with, what it pays for, and how much code that is.
#include "bench/specialization/specialization.h"

#include <gtest/gtest.h>

#include "bench/against/child_render.h"
#include "bench/specialization/code_size.h"
#include "metrics/image/atomic_file.h"
#include "tests/bench/small_box.h"

namespace wavecrest {
namespace {

TEST(Specialization, rendersTheGeneralImageAndSaysWhatIsPaidFor) {
  const SpecializationResult result = measureSpecialization(smallBox(48, 32), settingsOf(Method::bpt), 1);
  EXPECT_EQ(result.needs, std::vector<std::string>{"light paths"});
  EXPECT_EQ(result.rows.back().specialization, Specialization::complete);
  EXPECT_EQ(result.rows.back().speedup.value, 1);
  EXPECT_TRUE(result.rows.back().sameBits);
  EXPECT_EQ(result.rows.back().paysFor.size(), 9u) << "all but light paths";
  EXPECT_FALSE(result.anyDiffers());
  for (const FeatureSetRow& row : result.rows) {
    EXPECT_GT(row.bytesPerPath, 0u);
    EXPECT_LT(row.pixelDifference, 0.1);
    EXPECT_LE(row.bytesPerPath, result.rows.back().bytesPerPath);
  }
  if (!isCompiled(Precision::floating, Specialization::diffuse)) GTEST_SKIP() << "only general kernels are compiled";
  ASSERT_EQ(result.rows.size(), 5u) << "those with light paths";
  EXPECT_EQ(result.chosen().specialization, Specialization::diffuseBidirectional);
  EXPECT_TRUE(result.chosen().paysFor.empty());
  EXPECT_EQ(result.rows[1].paysFor, (std::vector<std::string>{"specular BSDFs", "spheres"}));
}

TEST(CodeBytes, areMoreForMoreFeaturesAndNoneForOthersNames) {
  const std::vector<unsigned char> program = readFileBytes(ownBinary());
  const auto bytes = [&](uint32_t features) { return codeBytes(program, bestIsa(), Precision::floating, features); };
  ASSERT_TRUE(bytes(kAllFeatures).has_value()) << "the test's program is not stripped";
  EXPECT_GT(*bytes(kAllFeatures), 10000u);
  EXPECT_EQ(*bytes(123456), 0u);
  if (!isCompiled(Precision::floating, Specialization::diffuse)) GTEST_SKIP() << "only general kernels are compiled";
  EXPECT_GT(*bytes(0), 1000u);
  EXPECT_LT(*bytes(0), *bytes(kAllFeatures));
}

TEST(CodeBytes, ofAFileThatIsNoProgramAreNone) {
  const std::vector<unsigned char> text(1000, 'x');
  EXPECT_EQ(codeBytes(text, bestIsa(), Precision::floating, 0), std::nullopt);
  EXPECT_EQ(codeBytes({}, bestIsa(), Precision::floating, 0), std::nullopt);
  // A program that ends within its header.
  std::vector<unsigned char> program = readFileBytes(ownBinary());
  program.resize(64);
  EXPECT_EQ(codeBytes(program, bestIsa(), Precision::floating, 0), std::nullopt);
}

}  // namespace
}  // namespace wavecrest
