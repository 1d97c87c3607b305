// What a scene renders with, and what it pays for.
#include "bench/specialization/specialization.h"

#include <gtest/gtest.h>

#include "tests/bench/small_box.h"

namespace wavecrest {
namespace {

TEST(Specialization, rendersTheCompleteImageAndSaysWhatIsPaidFor) {
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
  if (!isCompiled(Precision::floating, Specialization::diffuse))
    GTEST_SKIP() << "only the complete kernels are compiled";
  ASSERT_EQ(result.rows.size(), 4u) << "those with light paths";
  EXPECT_EQ(result.chosen().specialization, Specialization::diffuseBidirectional);
  EXPECT_TRUE(result.chosen().paysFor.empty());
  EXPECT_EQ(result.rows[1].paysFor, (std::vector<std::string>{"specular BSDFs", "spheres"}));
}

}  // namespace
}  // namespace wavecrest
