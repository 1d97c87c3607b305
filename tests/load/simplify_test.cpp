// Features that change no image are removed, and no others.
#include "engine/load/simplify.h"

#include <gtest/gtest.h>

#include <cmath>

namespace wavecrest {
namespace {

// Two triangles that share an edge, the second one turned up by `angle` radians; normals are the faces' but for `tilt`.
Scene hinge(double angle, double tilt) {
  const auto up = static_cast<float>(std::sin(angle)), along = static_cast<float>(std::cos(angle));
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}};
  mesh.positions[5] = {0.5f + 0.5f * along, 0.5f + 0.5f * along, up * std::sqrt(0.5f)};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  const auto s = static_cast<float>(std::sin(tilt)), c = static_cast<float>(std::cos(tilt));
  const float r = std::sqrt(0.5f);
  for (size_t i = 0; i < 3; ++i) mesh.normals.push_back({s, 0, c});
  for (size_t i = 0; i < 3; ++i) mesh.normals.push_back({-r * up, -r * up, along});
  Scene scene;
  scene.shapes.push_back({.id = "", .kind = mesh, .material = kNone, .emitter = kNone, .source = {}});
  return scene;
}

bool hasNormals(const Scene& scene) { return !std::get<Mesh>(scene.shapes[0].kind).normals.empty(); }

TEST(SimplifyScene, dropsNormalsOfFacesAlone) {
  for (const double angle : {0.0, 0.3, 1.2}) {
    Scene flat = hinge(angle, 0);
    simplifyScene(flat);
    EXPECT_FALSE(hasNormals(flat)) << angle;
    Scene rounded = hinge(angle, 1e-6);
    simplifyScene(rounded);
    EXPECT_FALSE(hasNormals(rounded)) << "within the rounding of files";
    Scene tilted = hinge(angle, 3e-5);
    simplifyScene(tilted);
    EXPECT_TRUE(hasNormals(tilted)) << "of a mesh of many triangles that is gently curved";
    Scene turned = hinge(angle, 3.14159265);
    simplifyScene(turned);
    EXPECT_TRUE(hasNormals(turned)) << "normals that point inwards turn the shading frame";
  }
}

uint32_t addBitmap(Scene& scene, uint32_t channels, std::vector<float> pixels) {
  auto bitmap = std::make_shared<Bitmap>();
  bitmap->width = static_cast<uint32_t>(pixels.size()) / channels;
  bitmap->height = 1;
  bitmap->channels = channels;
  bitmap->pixels = std::move(pixels);
  scene.textures.push_back({BitmapTexture{bitmap}, {}});
  return static_cast<uint32_t>(scene.textures.size() - 1);
}

// ---- compound BSDFs -------------------------------------------------------------------------------------------------

Material materialOf(decltype(Material::kind) kind) {
  Material material;
  material.kind = std::move(kind);
  return material;
}

TEST(SimplifyScene, twoEqualRoughnessesAreOne) {
  Scene scene;
  const uint32_t grey = addBitmap(scene, 1, {0.25f, 0.25f}), varied = addBitmap(scene, 1, {0.25f, 0.5f});
  scene.materials = {materialOf(Conductor{.alpha = {0.25}, .alphaV = TexturedFloat{0, grey}}),
                     materialOf(Dielectric{.alpha = {0.25}, .alphaV = TexturedFloat{0, varied}}),
                     materialOf(Conductor{.alpha = {0.25}, .alphaV = TexturedFloat{0.5}})};
  simplifyScene(scene);
  EXPECT_FALSE(std::get<Conductor>(scene.materials[0].kind).alphaV.has_value());
  EXPECT_TRUE(std::get<Dielectric>(scene.materials[1].kind).alphaV.has_value());
  EXPECT_TRUE(std::get<Conductor>(scene.materials[2].kind).alphaV.has_value());
}

// Nothing of a blend is left where one BSDF has all the weight, but for adapters that both have.
TEST(SimplifyScene, blendOfOneIsThatOne) {
  Scene scene;
  const uint32_t one = addBitmap(scene, 1, {1.0f, 1.0f});
  scene.materials = {materialOf(Plastic{}), materialOf(Phong{}), materialOf(Diffuse{})};
  scene.materials[1].twoSided = true;
  scene.materials[2].opacity = TexturedFloat{0.25};
  scene.materials.push_back(materialOf(Blend{.materials = {0, 1}, .weights = {0, 1}}));
  scene.materials.push_back(materialOf(Blend{.materials = {1, 0}, .weights = {}, .weightTexture = one}));
  scene.materials.push_back(materialOf(Blend{.materials = {0, 1}, .weights = {0.5, 0.5}}));
  scene.materials.push_back(materialOf(Blend{.materials = {0, 1}, .weights = {0.5, 0}}));
  scene.materials.push_back(materialOf(Blend{.materials = {2}, .weights = {1}}));
  scene.materials.push_back(scene.materials.back());
  scene.materials[3].opacity = scene.materials[8].opacity = TexturedFloat{0.5};
  simplifyScene(scene);
  EXPECT_TRUE(std::holds_alternative<Phong>(scene.materials[3].kind));
  EXPECT_TRUE(scene.materials[3].twoSided);
  EXPECT_EQ(scene.materials[3].opacity->value, 0.5);
  EXPECT_TRUE(std::holds_alternative<Plastic>(scene.materials[4].kind));
  EXPECT_EQ(std::get<Blend>(scene.materials[5].kind).materials.size(), 2u);
  EXPECT_EQ(std::get<Blend>(scene.materials[6].kind).materials, std::vector<uint32_t>{0}) << "half of it";
  EXPECT_TRUE(std::holds_alternative<Diffuse>(scene.materials[7].kind));
  EXPECT_EQ(scene.materials[7].opacity->value, 0.25);
  EXPECT_TRUE(std::holds_alternative<Blend>(scene.materials[8].kind)) << "opacities around both";
}

// What takes all light is no part, and the others keep their weights.
TEST(SimplifyScene, blendsHaveNoBlackParts) {
  Scene scene;
  const Material black = materialOf(Diffuse{{{0, 0, 0}}});
  Material thin = black;
  thin.opacity = TexturedFloat{0.5};
  scene.materials = {materialOf(Conductor{}), black, thin};
  scene.materials.push_back(materialOf(Blend{.materials = {1, 0}, .weights = {0.5, 0.25}}));
  scene.materials.push_back(materialOf(Blend{.materials = {1, 1}, .weights = {0.5, 0.25}}));
  scene.materials.push_back(materialOf(Blend{.materials = {0, 2}, .weights = {0.5, 0.5}}));
  scene.materials.push_back(materialOf(Blend{.materials = {0, 1}, .weights = {0, 1}}));
  scene.materials.push_back(materialOf(Blend{.materials = {2, 1}, .weights = {0.5, 0.5}}));
  simplifyScene(scene);
  const auto blend = [&](size_t i) { return std::get<Blend>(scene.materials[i].kind); };
  EXPECT_EQ(blend(3).materials, std::vector<uint32_t>{0});
  EXPECT_EQ(blend(3).weights, std::vector<double>{0.25});
  EXPECT_EQ(blend(4).materials, std::vector<uint32_t>{1}) << "one part stays";
  EXPECT_EQ(blend(5).materials.size(), 2u) << "light goes through the black part";
  EXPECT_TRUE(std::holds_alternative<Diffuse>(scene.materials[6].kind)) << "the part that has the weight";
  EXPECT_EQ(blend(7).materials.size(), 2u) << "black beside a mask keeps what passes untinted";
}

TEST(SimplifyScene, replacesTexturesOfOneColour) {
  Scene scene;
  const uint32_t plain = addBitmap(scene, 3, {0.2f, 0.3f, 0.4f, 0.2f, 0.3f, 0.4f}),
                 varied = addBitmap(scene, 3, {0.2f, 0.3f, 0.4f, 0.2f, 0.3f, 0.5f}),
                 grey = addBitmap(scene, 1, {0.25f, 0.25f, 0.25f});
  scene.textures.push_back({CheckerboardTexture{{0.5, 0.6, 0.7}, {0.5, 0.6, 0.7}}, {}});
  for (const uint32_t texture : {plain, varied, grey, 3u}) {
    Material material;
    material.kind = Diffuse{{{1, 1, 1}, texture}};
    scene.materials.push_back(material);
  }
  Material rough;
  rough.kind = Conductor{.alpha = {1, grey}};
  scene.materials.push_back(rough);
  std::get<Conductor>(rough.kind).alpha = {1, plain};
  scene.materials.push_back(rough);
  simplifyScene(scene);
  const auto reflectance = [&](size_t i) { return std::get<Diffuse>(scene.materials[i].kind).reflectance; };
  EXPECT_EQ(reflectance(0).texture, kNone);
  EXPECT_FLOAT_EQ(static_cast<float>(reflectance(0).value[1]), 0.3f);
  EXPECT_EQ(reflectance(1).texture, varied);
  EXPECT_EQ(reflectance(2).texture, kNone);
  EXPECT_EQ(reflectance(2).value, (Rgb{0.25, 0.25, 0.25}));
  EXPECT_EQ(reflectance(3).texture, kNone);
  EXPECT_EQ(reflectance(3).value, (Rgb{0.5, 0.6, 0.7}));
  EXPECT_EQ(std::get<Conductor>(scene.materials[4].kind).alpha.texture, kNone);
  EXPECT_EQ(std::get<Conductor>(scene.materials[4].kind).alpha.value, 0.25);
  EXPECT_EQ(std::get<Conductor>(scene.materials[5].kind).alpha.texture, plain) << "a colour is no number";
}

TEST(SimplifyScene, dropsMapsAndOpacitiesThatDoNothing) {
  Scene scene;
  const uint32_t level = addBitmap(scene, 1, {0.5f, 0.5f}), steps = addBitmap(scene, 1, {0.5f, 0.6f}),
                 straight = addBitmap(scene, 3, {0.5f, 0.5f, 1, 0.5f, 0.5f, 1}),
                 leaning = addBitmap(scene, 3, {0.6f, 0.5f, 1, 0.6f, 0.5f, 1}), one = addBitmap(scene, 1, {1, 1});
  const auto add = [&](uint32_t bump, uint32_t normal, std::optional<TexturedFloat> opacity) {
    Material material;
    material.bumpTexture = bump;
    material.normalTexture = normal;
    material.opacity = opacity;
    scene.materials.push_back(material);
  };
  add(level, straight, TexturedFloat{1, kNone});
  add(steps, leaning, TexturedFloat{0.5, kNone});
  add(kNone, kNone, TexturedFloat{1, one});
  simplifyScene(scene);
  EXPECT_EQ(scene.materials[0].bumpTexture, kNone);
  EXPECT_EQ(scene.materials[0].normalTexture, kNone);
  EXPECT_FALSE(scene.materials[0].opacity);
  EXPECT_EQ(scene.materials[1].bumpTexture, steps);
  EXPECT_EQ(scene.materials[1].normalTexture, leaning);
  EXPECT_TRUE(scene.materials[1].opacity);
  EXPECT_FALSE(scene.materials[2].opacity);
}

}  // namespace
}  // namespace wavecrest
