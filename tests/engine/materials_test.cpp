// Materials that kernels could not evaluate are refused.
#include "engine/compile/materials.h"

#include <gtest/gtest.h>

#include "engine/scene/scene_error.h"
#include "tests/engine/test_scenes.h"

namespace wavecrest {
namespace {

// A base that reflects more than arrives makes an endless sum of what the boundary sends back to it.
TEST(Materials, plasticsWhoseInnerReflectionsGrowAreRefused) {
  for (const double alpha : {0.0, 0.3}) {
    for (const bool nonlinear : {false, true}) {
      for (const double most : {1.2, 2.5}) {
        Scene scene;
        scene.textures.push_back({.kind = CheckerboardTexture{.color0 = {0.2, most, 0.2}}});
        Material material;
        material.kind = Plastic{.diffuseReflectance = {.texture = 0}, .alpha = {alpha}, .nonlinear = nonlinear};
        const auto compile = [&] { compileMaterial(material, scene); };
        if (nonlinear && most > 1.5) {
          EXPECT_THROW(compile(), SceneError) << alpha;
        } else {
          EXPECT_NO_THROW(compile()) << alpha << ", values up to " << most;
        }
      }
    }
  }
}

}  // namespace
}  // namespace wavecrest
