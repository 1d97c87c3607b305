// Which instances become copies, and scenes whose instances are refused.
#include <gtest/gtest.h>

#include <string>

#include "engine/plan/render_plan.h"
#include "engine/scene/scene_error.h"
#include "tests/engine/instanced_scenes.h"
#include "tests/refusal.h"

namespace wavecrest {
namespace {

bool keeps(const Scene& scene, Instancing instancing = Instancing::automatic, Accel accel = Accel::automatic) {
  return keepsInstances(scene, accel, instancing);
}
std::string refusalOfRule(const Scene& scene, Instancing instancing, Accel accel) {
  return refusalOf<SceneError>([&] { keeps(scene, instancing, accel); });
}

TEST(InstancingRule, copiesWhereTheyAreFew) {
  Scene scene = placedScene(allKindsOfPlaces(), false);
  EXPECT_FALSE(keeps(scene));
  EXPECT_TRUE(keeps(scene, Instancing::kept));
  scene.instances.resize(1, scene.instances.front());
  EXPECT_FALSE(keeps(scene));
  scene.instances.resize(1000, scene.instances.front());
  EXPECT_TRUE(keeps(scene));
  EXPECT_FALSE(keeps(scene, Instancing::expanded));
}
// 256 segments in 4 rings, the innermost of triangles, and in 4 parts.
TEST(InstancingRule, countsTheTrianglesOfDisksAndCylinders) {
  const auto keepsCopies = [](const auto& kind, size_t copies) {
    Scene scene;
    scene.groups.push_back({.id = "round", .source = {}});
    addShape(scene, kind, 0).group = 0;
    addInstance(scene, 0, allKindsOfPlaces().front());
    scene.instances.resize(1 + copies, scene.instances.front());
    return keeps(scene);
  };
  EXPECT_FALSE(keepsCopies(Disk{}, kMostCopies / 1792));
  EXPECT_TRUE(keepsCopies(Disk{}, kMostCopies / 1792 + 1));
  EXPECT_FALSE(keepsCopies(Cylinder{}, kMostCopies / 2048));
  EXPECT_TRUE(keepsCopies(Cylinder{}, kMostCopies / 2048 + 1));
}
TEST(InstancingRule, takesNoNoticeOfGroupsWithoutInstances) {
  Scene scene = placedScene(allKindsOfPlaces(), false);
  scene.groups.push_back({.id = "spare", .source = {}});
  addShape(scene, ballMesh({0, 0, 0}, 0.2, 8), 0).group = static_cast<uint32_t>(scene.groups.size() - 1);
  EXPECT_FALSE(keeps(scene));
}
TEST(InstancingRule, keepsSpheresThatBecomeEllipsoids) {
  const Scene scene = placedScene(allKindsOfPlaces(), true);
  EXPECT_TRUE(keeps(scene));
  EXPECT_NE(refusalOfRule(scene, Instancing::expanded, Accel::automatic).find("scales it differently"),
            std::string::npos);
}
TEST(InstancingRule, refusesIntersectorsThatKnowNone) {
  const Scene round = placedScene(allKindsOfPlaces(), false);
  Scene deformed = placedScene(allKindsOfPlaces(), true);
  deformed.instances[3].source = {.file = "uneven.xml", .line = 7};  // the first that scales unevenly
  for (const Accel accel : {Accel::small, Accel::embree}) {
    EXPECT_FALSE(keeps(round, Instancing::automatic, accel));
    EXPECT_NE(refusalOfRule(round, Instancing::kept, accel).find("`--instances expand`"), std::string::npos);
    // Copies are no way out where a sphere becomes an ellipsoid.
    const std::string refusal = refusalOfRule(deformed, Instancing::automatic, accel);
    EXPECT_TRUE(refusal.starts_with("uneven.xml:7: ")) << refusal;
    EXPECT_TRUE(refusal.ends_with("expected `--accel bvh`")) << refusal;
  }
}

// ---- what single precision holds ------------------------------------------------------------------------------------

void compile(const Scene& scene, Instancing instancing) { compileScene<float>(scene, Accel::bvh, true, instancing); }
std::string compileRefusal(const Scene& scene, Instancing instancing) {
  return refusalOf<SceneError>([&] { compile(scene, instancing); });
}

// Rays are intersected in the group's space, whose products float must hold.
TEST(Instances, ofTinyGroupsAreRefusedUnlessCopied) {
  Scene scene;
  scene.groups.push_back({.id = "empty", .source = {}});
  scene.groups.push_back({.id = "tiny", .source = {.file = "tiny.xml", .line = 3}});
  addShape(scene, Rectangle{{0, 0, 0}, {1e-13, 0, 0}, {0, 1e-13, 0}}, addDiffuse(scene, 0.5, 0.5, 0.5)).group = 1;
  addInstance(scene, 1, placedAt({0, 0, 0}, {{1e13, 0, 0}, {0, 1e13, 0}, {0, 0, 1e13}}));
  setCamera(scene, {0, 0, 2}, 60, 8, 8);
  const std::string refusal = compileRefusal(scene, Instancing::kept);
  EXPECT_TRUE(refusal.starts_with("tiny.xml:3: the radius of shapegroup tiny is 7")) << refusal;
  EXPECT_TRUE(refusal.ends_with(", or `--instances expand`")) << refusal;
  EXPECT_NO_THROW(compile(scene, Instancing::expanded));
}

// The square of the length of a direction there, or its product with a face's edges.
TEST(Instances, atScalesThatFloatDoesNotHoldAreRefusedUnlessCopied) {
  const auto expectRefusal = [](Scene scene, const char* what) {
    scene.instances[0].source = {.file = "placed.xml", .line = 5};
    const std::string refusal = compileRefusal(scene, Instancing::kept);
    EXPECT_TRUE(refusal.starts_with("placed.xml:5: ")) << what << ": " << refusal;
    EXPECT_TRUE(refusal.ends_with("expected `--instances expand`")) << what << ": " << refusal;
    EXPECT_NO_THROW(compile(scene, Instancing::expanded)) << what;
  };
  EXPECT_NO_THROW(compile(tinySphere(1e12), Instancing::kept));
  expectRefusal(tinySphere(1e20), "enlarged");
  Scene reduced;
  reduced.groups.push_back({.id = "large", .source = {}});
  addShape(reduced, Rectangle{{-1e12, -1e12, 0}, {2e12, 0, 0}, {0, 2e12, 0}}, addDiffuse(reduced, 0.5, 0.5, 0.5))
      .group = 0;
  addInstance(reduced, 0, placedAt({0, 0, 0}, {{1e-15, 0, 0}, {0, 1e-15, 0}, {0, 0, 1e-15}}));
  setCamera(reduced, {0, 0, 2e-3}, 60, 8, 8);
  expectRefusal(reduced, "reduced");
}

// A sphere counts with the radius of its copies.
TEST(Instances, ofSpheresAreRefusedByTheRadiusOfTheirCopies) {
  const auto ballOf = [](double radius, double scale) {
    Scene scene;
    scene.groups.push_back({.id = "ball", .source = {}});
    const uint32_t grey = addDiffuse(scene, 0.5, 0.5, 0.5);
    addShape(scene, Rectangle{{-1, -1, 0}, {2, 0, 0}, {0, 2, 0}}, grey);
    Sphere sphere{.center = {0, 0, 0}, .radius = radius};
    sphere.toWorld = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
    addShape(scene, sphere, grey).group = 0;
    addInstance(scene, 0, placedAt({0, 0, 0.5}, {{scale, 0, 0}, {0, scale, 0}, {0, 0, scale}}));
    setCamera(scene, {0, 0, 2}, 60, 8, 8);
    return scene;
  };
  EXPECT_NO_THROW(compile(ballOf(1e-20, 1e19), Instancing::expanded));
  const std::string refusal = compileRefusal(ballOf(0.1, 1e-19), Instancing::expanded);
  EXPECT_NE(refusal.find("a sphere's radius is 1e-20;"), std::string::npos) << refusal;
}

}  // namespace
}  // namespace wavecrest
