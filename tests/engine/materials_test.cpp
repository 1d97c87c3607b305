// Plastics that kernels could not evaluate are refused, and bright phongs are scaled down.
#include "engine/compile/materials.h"

#include <gtest/gtest.h>

#include <memory>

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
        for (const TexturedRgb& base : {TexturedRgb{.texture = 0}, TexturedRgb{.value = {0.2, most, 0.2}}}) {
          Material material;
          material.kind = Plastic{.diffuseReflectance = base, .alpha = {alpha}, .nonlinear = nonlinear};
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
}

// The fourth texel of a baked triangle is outside of it, and extrapolates the colours of its corners.
TEST(Materials, bakedColoursCountWithinTheirTriangles) {
  const auto bitmap = std::make_shared<const Bitmap>(
      Bitmap{.width = 2, .height = 2, .channels = 1, .pixels = {0.0f, 1.0f, 1.0f, 2.0f}});
  for (const bool ofMesh : {false, true}) {
    Scene scene;
    scene.textures.push_back({.kind = BitmapTexture{.bitmap = bitmap, .attribute = ofMesh ? bitmap : nullptr}});
    Material material;
    material.kind = Plastic{.diffuseReflectance = {.texture = 0}, .nonlinear = true};
    const auto compile = [&] { compileMaterial(material, scene); };
    if (ofMesh) {
      EXPECT_NO_THROW(compile());
    } else {
      EXPECT_THROW(compile(), SceneError);
    }
  }
}

// As in Mitsuba 0.6, which adds the greatest values of both colours in each channel.
TEST(Materials, phongsAreScaledByTheirGreatestValues) {
  Scene scene;
  scene.textures.push_back({.kind = CheckerboardTexture{.color0 = {0, 0, 0}, .color1 = {0.95, 0.1, 0.1}}});
  Material material;
  material.kind = Phong{.diffuseReflectance = {.texture = 0}, .specularReflectance = {{0.2, 0.4, 0.4}}};
  const MaterialRecord record = compileMaterial(material, scene);
  EXPECT_FLOAT_EQ(record.reflectance[0], 0.99f / 1.15f);
  EXPECT_FLOAT_EQ(record.specular[0], 0.2f * 0.99f / 1.15f);
}

}  // namespace
}  // namespace wavecrest
