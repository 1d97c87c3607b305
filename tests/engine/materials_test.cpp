// Plastics that kernels could not evaluate are refused, and bright phongs are scaled down.
#include "engine/compile/materials.h"

#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

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

// Share of the specular lobe in the samples of a plastic.
float specularPickOf(const Scene& scene, const Plastic& plastic) {
  Material material;
  material.kind = plastic;
  return compileMaterial(material, scene).specularPick;
}

// By all four texels the mean of the diffuse colour would be 0, and its lobe would have no samples.
TEST(Materials, bakedColoursHaveTheMeanOfTheirTriangles) {
  const auto bitmap = std::make_shared<const Bitmap>(
      Bitmap{.width = 2, .height = 2, .channels = 1, .pixels = {1.0f, 0.0f, 0.0f, -1.0f}});
  Scene scene;
  scene.textures.push_back({.kind = BitmapTexture{.bitmap = bitmap, .attribute = bitmap}});
  EXPECT_FLOAT_EQ(specularPickOf(scene, {.diffuseReflectance = {.texture = 0}}), 0.75f);
}

TEST(Materials, lobesOfDarkTexturesWithBrightTexelsKeepAShare) {
  Bitmap spark{.width = 64, .height = 64, .channels = 1, .pixels = std::vector<float>(size_t{64} * 64)};
  spark.pixels[100] = 1;
  Scene scene;
  scene.textures.push_back({.kind = BitmapTexture{.bitmap = std::make_shared<const Bitmap>(std::move(spark))}});
  const TexturedRgb dark{.texture = 0};
  EXPECT_FLOAT_EQ(specularPickOf(scene, {.specularReflectance = dark}), 1.0f / 16);
  EXPECT_FLOAT_EQ(specularPickOf(scene, {.diffuseReflectance = dark}), 15.0f / 16);
  // A black lobe needs no samples, and constants have Mitsuba's share.
  EXPECT_EQ(specularPickOf(scene, {.diffuseReflectance = {{0, 0, 0}}, .specularReflectance = dark}), 1.0f);
  EXPECT_FLOAT_EQ(specularPickOf(scene, {.diffuseReflectance = {{0.01, 0.01, 0.01}}}), 1 / 1.01f);
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
