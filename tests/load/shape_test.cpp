// Analytic shapes: defaults, transforms, and which way they face. Orientation as observed in Mitsuba 3.9.
#include <cmath>

#include "tests/load/scene_file.h"

namespace wavecrest {
namespace {

template <class Kind>
Kind shapeOf(std::string_view type, std::string_view content = "") {
  const Scene scene = loadBody("<shape type=\"" + std::string(type) + "\">" + std::string(content) + "</shape>");
  return std::get<Kind>(scene.shapes.at(0).kind);
}
void expectShapeError(std::string_view type, std::string_view content, std::string_view text) {
  expectErrorOnLine2("<shape type=\"" + std::string(type) + "\">" + std::string(content) + "</shape>", text);
}

Double3 crossOf(const Double3& a, const Double3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double facing(const Rectangle& r) { return crossOf(r.edgeU, r.edgeV)[2]; }
double facing(const Disk& d) { return crossOf(d.axisU, d.axisV)[2]; }

constexpr std::string_view kFlip = R"(<boolean name="flip_normals" value="true"/>)";
constexpr std::string_view kMirror = R"(<transform name="to_world"><scale x="-1"/></transform>)";

TEST(Rectangle, SpansMinusOneToOneAndFacesZ) {
  const Rectangle r = shapeOf<Rectangle>("rectangle");
  EXPECT_EQ(r.corner, (Double3{-1, -1, 0}));
  EXPECT_EQ(r.edgeU, (Double3{2, 0, 0}));
  EXPECT_EQ(r.edgeV, (Double3{0, 2, 0}));
  EXPECT_FALSE(r.mirrored);
}

TEST(Rectangle, FlipNormalsTurnsItAndKeepsTextureCoordinates) {
  const Rectangle r = shapeOf<Rectangle>("rectangle", kFlip);
  EXPECT_LT(facing(r), 0);
  // (u, v) = (0, 0) of the texture is still at (-1, -1): with mirrored it is at the end of edgeU.
  EXPECT_TRUE(r.mirrored);
  EXPECT_EQ(r.corner[0] + r.edgeU[0], -1);
}

TEST(Rectangle, MirroringTransformLeavesItFacingZ) {
  const Rectangle r = shapeOf<Rectangle>("rectangle", kMirror);
  EXPECT_GT(facing(r), 0);
  EXPECT_TRUE(r.mirrored);
  EXPECT_EQ(r.corner[0] + r.edgeU[0], 1);  // texture (0, 0) moved to x = 1
}

TEST(Rectangle, WithoutAreaIsLeftOutWithItsLight) {
  for (const char* light : {"", R"(<emitter type="area" id="light"/>)"}) {
    const Scene scene = loadBody(R"(<shape type="rectangle"><transform name="to_world"><scale x="0"/></transform>)" +
                                 std::string(light) + "</shape>" + std::string(kSphere));
    EXPECT_EQ(scene.shapes.size(), 1u);
    EXPECT_TRUE(scene.emitters.empty());
    ASSERT_EQ(scene.notes.size(), 1u);
    EXPECT_EQ(scene.notes[0].what, "shape \"rectangle\" without area");
  }
}

TEST(Disk, HasRadiusOneAndFacesZ) {
  const Disk d = shapeOf<Disk>("disk");
  EXPECT_EQ(d.center, (Double3{0, 0, 0}));
  EXPECT_EQ(d.axisU, (Double3{1, 0, 0}));
  EXPECT_EQ(d.axisV, (Double3{0, 1, 0}));
}

TEST(Disk, FlipNormalsTurnsItAMirrorDoesNot) {
  EXPECT_LT(facing(shapeOf<Disk>("disk", kFlip)), 0);
  EXPECT_GT(facing(shapeOf<Disk>("disk", kMirror)), 0);
  EXPECT_TRUE(shapeOf<Disk>("disk", kMirror).mirrored);
}

TEST(Disk, ShearIsRefused) {
  expectShapeError("disk", R"(<transform name="to_world"><matrix value="1 1 0 0 1 0 0 0 1"/></transform>)", "sheared");
}

TEST(Sphere, HasRadiusOneAtTheOrigin) {
  const Sphere s = shapeOf<Sphere>("sphere");
  EXPECT_EQ(s.center, (Double3{0, 0, 0}));
  EXPECT_EQ(s.radius, 1);
  EXPECT_FALSE(s.flipNormals);
}

TEST(Sphere, CenterAndRadiusComeBeforeToWorld) {
  const Sphere s = shapeOf<Sphere>("sphere", R"(<point name="center" x="1" y="2" z="3"/><float name="radius" value="2"/>
      <transform name="to_world"><scale value="3"/><translate x="10"/></transform>)");
  EXPECT_EQ(s.center, (Double3{13, 6, 9}));
  EXPECT_EQ(s.radius, 6);
}

// Mitsuba 0.6 takes the scale out of to_world before it moves the center.
TEST(Sphere, CenterIsNotScaledInOldFiles) {
  const Scene scene = load(sceneXml(R"(<shape type="sphere"><point name="center" x="1" y="2" z="3"/>
      <float name="radius" value="2"/><transform name="toWorld"><scale value="4"/><translate x="10"/></transform>
      </shape>)" + std::string(kSensor),
                                    "0.6.0"));
  const Sphere& s = std::get<Sphere>(scene.shapes.at(0).kind);
  EXPECT_EQ(s.center, (Double3{11, 2, 3}));
  EXPECT_EQ(s.radius, 8);
}

TEST(Sphere, MirroringTransformTurnsItInsideOut) {
  EXPECT_TRUE(shapeOf<Sphere>("sphere", kMirror).flipNormals);
  EXPECT_TRUE(shapeOf<Sphere>("sphere", kFlip).flipNormals);
  EXPECT_FALSE(shapeOf<Sphere>("sphere", std::string(kMirror) + std::string(kFlip)).flipNormals);
}

// Normals point away from the center in Mitsuba 0.6, whatever to_world is.
TEST(Sphere, MirroringTransformLeavesItFacingOutwardInOldFiles) {
  const auto isFlipped = [](std::string_view content) {
    const Scene scene =
        load(sceneXml(R"(<shape type="sphere">)" + std::string(content) + "</shape>" + std::string(kSensor), "0.6.0"));
    return std::get<Sphere>(scene.shapes.at(0).kind).flipNormals;
  };
  EXPECT_FALSE(isFlipped(kMirror));
  EXPECT_TRUE(isFlipped(std::string(kMirror) + std::string(kFlip)));
}

TEST(Sphere, NonUniformScaleIsRefused) {
  expectShapeError("sphere", R"(<transform name="to_world"><scale x="2"/></transform>)", "scaled differently");
}

TEST(Sphere, RadiusMustBePositive) {
  expectShapeError("sphere", R"(<float name="radius" value="0"/>)", "not positive");
  expectShapeError("sphere", R"(<float name="radius" value="-1"/>)", "not positive");
}

TEST(Cylinder, RunsAlongZ) {
  const Cylinder c = shapeOf<Cylinder>("cylinder");
  EXPECT_EQ(c.p0, (Double3{0, 0, 0}));
  EXPECT_EQ(c.p1, (Double3{0, 0, 1}));
  EXPECT_EQ(c.radius, 1);
  EXPECT_FALSE(c.flipNormals);
}

TEST(Cylinder, ScaleAcrossTheAxisChangesTheRadiusOnly) {
  const Cylinder c =
      shapeOf<Cylinder>("cylinder", R"(<transform name="to_world"><scale x="2" y="2" z="5"/></transform>)");
  EXPECT_NEAR(c.radius, 2, 1e-15);
  EXPECT_EQ(c.p1, (Double3{0, 0, 5}));
}

TEST(Cylinder, AngleTurnsWithTheTransform) {
  const Cylinder c =
      shapeOf<Cylinder>("cylinder", R"(<transform name="to_world"><rotate z="1" angle="90"/></transform>)");
  EXPECT_NEAR(c.phi0[1], 1, 1e-15);
  EXPECT_NEAR(c.phi90[0], -1, 1e-15);
}

TEST(Cylinder, IsItsOwnMirrorImage) {
  EXPECT_FALSE(shapeOf<Cylinder>("cylinder", kMirror).flipNormals);
  EXPECT_TRUE(shapeOf<Cylinder>("cylinder", std::string(kFlip) + std::string(kMirror)).flipNormals);
}

// Mitsuba 0.6 takes the cross product of the two tangents as the normal.
TEST(Cylinder, OfOldFilesFacesInwardInTheMirror) {
  const auto isFlipped = [](const std::string& content) {
    const std::string shape = "<shape type=\"cylinder\">" + content + "</shape>";
    const Scene scene = load(sceneXml(shape + std::string(kSensor), "0.6.0"));
    return std::get<Cylinder>(scene.shapes.at(0).kind).flipNormals;
  };
  EXPECT_FALSE(isFlipped(""));
  EXPECT_TRUE(isFlipped(std::string(kMirror)));
  EXPECT_FALSE(isFlipped(std::string(kFlip) + std::string(kMirror)));
}

TEST(Cylinder, MistakesAreErrors) {
  expectShapeError("cylinder", R"(<point name="p1" x="0" y="0" z="0"/>)", "no length");
  expectShapeError("cylinder", R"(<transform name="to_world"><scale x="2"/></transform>)", "elliptic or slanted");
}

TEST(Cube, HasTwelveFacetedTrianglesFacingOutward) {
  const Mesh mesh = shapeOf<Mesh>("cube");
  ASSERT_EQ(mesh.triangles.size(), 12u);
  EXPECT_EQ(mesh.positions.size(), 24u);
  EXPECT_TRUE(mesh.normals.empty());
  double sixVolumes = 0;  // divergence theorem: positive if every face looks outward
  for (const auto& t : mesh.triangles) {
    const auto at = [&](size_t i) {
      const Float3& p = mesh.positions[t[i]];
      return Double3{p[0], p[1], p[2]};
    };
    const Double3 n = crossOf(at(1), at(2)), p = at(0);
    const double volume = p[0] * n[0] + p[1] * n[1] + p[2] * n[2];
    EXPECT_GT(volume, 0);
    sixVolumes += volume;
  }
  EXPECT_EQ(sixVolumes, 6 * 8);
}

TEST(Cube, HasMitsubasTextureCoordinates) {
  const Mesh mesh = shapeOf<Mesh>("cube");
  ASSERT_EQ(mesh.uvs.size(), 24u);
  // Face +z: (1, -1, 1) has (0, 1).
  EXPECT_EQ(mesh.positions[12], (Float3{1, -1, 1}));
  EXPECT_EQ(mesh.uvs[12], (Float2{0, 1}));
}

TEST(Shapes, OutOfScopeOnesSayWhy) {
  expectErrorOnLine2(R"(<shape type="bsplinecurve"/>)", "since wavecrest renders no curves");
  expectErrorOnLine2(R"(<shape type="sdfgrid"/>)", "since wavecrest renders no signed distance fields");
  expectErrorOnLine2(R"(<shape type="sphere"><bsdf type="hair"/></shape>)", "since wavecrest renders no hair");
  expectErrorOnLine2(R"(<shape type="sphere"><bsdf type="polarizer"/></shape>)", "renders no polarisation");
}

TEST(Cube, StaysOutwardInAMirror) {
  const Mesh mesh = shapeOf<Mesh>("cube", kMirror);
  const auto& t = mesh.triangles[0];
  const Float3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
  const float ny = (b[2] - a[2]) * (c[0] - a[0]) - (b[0] - a[0]) * (c[2] - a[2]);
  EXPECT_LT(ny, 0);  // first face is -y
}

TEST(Instance, NamesTheGroupAndItsPlace) {
  const Scene scene =
      loadBody(R"(<shape type="shapegroup" id="g"><shape type="sphere"/><shape type="rectangle"/></shape>
    <shape type="shapegroup" id="unused"><shape type="cube"/></shape>
    <shape type="instance"><ref id="g"/><transform name="to_world"><translate x="5"/></transform></shape>
    <shape type="cube"/>
    <shape type="instance"><ref id="g"/><transform name="to_world"><scale x="2" y="-3"/></transform></shape>)");
  ASSERT_EQ(scene.groups.size(), 1u);
  EXPECT_EQ(scene.groups[0].id, "g");
  ASSERT_EQ(scene.shapes.size(), 3u);  // those of the group once, in its space
  EXPECT_EQ(std::get<Sphere>(scene.shapes[0].kind).center, (Double3{0, 0, 0}));
  EXPECT_EQ(scene.shapes[0].group, 0u);
  EXPECT_EQ(scene.shapes[1].group, 0u);
  EXPECT_EQ(scene.shapes[2].group, kNone);
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.instances[0].group, 0u);
  EXPECT_EQ(scene.instances[0].toWorld[0][3], 5);
  EXPECT_EQ(scene.instances[1].toWorld[1][1], -3);
}

TEST(Instance, OfAnInstanceIsRefused) {
  expectError(sceneXml(std::string(kSensor) + R"(
    <shape type="shapegroup" id="a"><shape type="sphere"/></shape>
    <shape type="shapegroup" id="b"><shape type="instance"><ref id="a"/></shape></shape>
    <shape type="instance"><ref id="b"/></shape>)"),
              3, "instance inside a shapegroup; expected only plain shapes");
}

TEST(Instance, ThatIsFlatIsRefused) {
  expectErrorOnLine2(R"(<shape type="shapegroup" id="g"><shape type="sphere"/></shape><shape type="instance">)"
                     R"(<ref id="g"/><transform name="to_world"><scale x="0"/></transform></shape>)",
                     "expected a to_world that has an inverse");
}

TEST(Instance, LightsInAGroupAreRefused) {
  expectError(sceneXml(std::string(kSensor) + R"(
    <shape type="shapegroup" id="g"><shape type="sphere"><emitter type="area"/></shape></shape>
    <shape type="instance"><ref id="g"/></shape>)"),
              2, "light inside a shapegroup");
}

TEST(Instance, MustReferToAGroup) {
  expectErrorOnLine2(R"(<shape type="sphere" id="s"/><shape type="instance"><ref id="s"/></shape>)",
                     "expected a shapegroup");
}

// Mitsuba 0.6 makes a boundary of it that does not change light, Mitsuba 3 a diffuse surface.
TEST(Shape, WithAMediumAndNoBsdfIsNullInOldFilesWithLenient) {
  const auto sceneOf = [](const std::string& content, std::string_view version) {
    return load(sceneXml("<shape type=\"cube\"><medium type=\"homogeneous\" name=\"interior\"/>" + content +
                             "</shape>" + std::string(kSensor),
                         version),
                {.lenient = true});
  };
  const auto opacityOf = [](const Scene& scene) {
    return scene.materials.at(scene.shapes.at(0).material).opacity.value_or(TexturedFloat{1}).value;
  };
  const Scene fog = sceneOf("", "0.6.0");
  EXPECT_EQ(opacityOf(fog), 0);
  ASSERT_EQ(fog.warnings.size(), 1u);
  EXPECT_NE(fog.warnings[0].find("(left out; its boundary is null)"), std::string::npos) << fog.warnings[0];
  EXPECT_EQ(opacityOf(sceneOf(R"(<bsdf type="diffuse"/>)", "0.6.0")), 1);
  EXPECT_EQ(opacityOf(sceneOf(R"(<emitter type="area"/>)", "0.6.0")), 1);
  EXPECT_EQ(opacityOf(sceneOf("", "3.0.0")), 1);
  expectError(sceneXml("\n<shape type=\"cube\"><medium type=\"homogeneous\"/></shape>" + std::string(kSensor), "0.6.0"),
              2, "<medium> in shape \"cube\": light transport in media is not supported; expected surfaces only");
}

}  // namespace
}  // namespace wavecrest
