// What kernels cannot index is refused before memory is taken for it.
#include <gtest/gtest.h>

#include <memory>

#include "engine/compile/record_array.h"
#include "engine/compile/textures.h"
#include "engine/scene/scene_error.h"

namespace wavecrest {
namespace {

Texture textureOf(const std::shared_ptr<const Bitmap>& bitmap) {
  return {.kind = BitmapTexture{.bitmap = bitmap}, .toUv = {}};
}

// Sizes alone: the check is made before pixels are read.
TEST(IndexLimits, BitmapsAreRefusedAbove31BitsOfFloats) {
  const auto large =
      std::make_shared<const Bitmap>(Bitmap{.width = 1u << 15, .height = 1u << 15, .channels = 1, .pixels = {}});
  Scene scene;
  scene.name = "large";
  scene.textures.push_back(textureOf(large));
  EXPECT_THROW(compileTextures(scene), SceneError);
}

TEST(IndexLimits, EnvironmentMapsAreRefusedLikewise) {
  EnvmapEmitter emitter;
  emitter.bitmap =
      std::make_shared<const Bitmap>(Bitmap{.width = 1u << 15, .height = 1u << 15, .channels = 3, .pixels = {}});
  EXPECT_THROW(compileEnvironment(emitter), SceneError);
}

TEST(IndexLimits, BitmapOfSeveralTexturesIsStoredOnce) {
  const auto small =
      std::make_shared<const Bitmap>(Bitmap{.width = 1, .height = 2, .channels = 1, .pixels = {0.25f, 0.5f}});
  Scene scene;
  scene.textures.assign(2, textureOf(small));
  scene.textures.push_back(textureOf(std::make_shared<const Bitmap>(*small)));
  const Textures textures = compileTextures(scene);
  EXPECT_EQ(textures.texels.size(), 12u);
  EXPECT_EQ(textures.records.at(1).offset, 0u);
  EXPECT_EQ(textures.records.at(2).offset, 6u);
}

// The last word of the last record has an index below 2^31.
TEST(IndexLimits, RecordsAreCountedByTheirWords) {
  EXPECT_EQ(kMostIndexed<PrimitiveRecord<float>>, size_t{1} << 27);
  EXPECT_EQ(kMostIndexed<PrimitiveRecord<double>>, size_t{1} << 26);
}

}  // namespace
}  // namespace wavecrest
