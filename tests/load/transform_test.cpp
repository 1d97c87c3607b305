// Transforms: every operation, their order, and how they are read. Expected matrices of lookat: Mitsuba 3.9.
#include <cmath>

#include "tests/load/scene_file.h"

namespace wavecrest {
namespace {

// to_world as the spot light keeps it.
Matrix4 transformOf(std::string_view operations) {
  const Scene scene = loadBody("<emitter type=\"spot\"><transform name=\"to_world\">" + std::string(operations) +
                               "</transform></emitter>");
  return std::get<SpotEmitter>(scene.emitters.at(0).kind).toWorld;
}

void expectMatrix(const Matrix4& m, const Matrix4& expected, double tolerance) {
  for (size_t i = 0; i < 4; ++i) {
    for (size_t j = 0; j < 4; ++j) EXPECT_NEAR(m[i][j], expected[i][j], tolerance) << "at " << i << ", " << j;
  }
}

constexpr double kFewUlps = 1e-15;   // a few ulp of numbers near 1
constexpr double kSixDigits = 1e-6;  // digits that Mitsuba prints

TEST(Transform, Translate) {
  expectMatrix(transformOf(R"(<translate x="1" y="2" z="3"/>)"),
               {{{1, 0, 0, 1}, {0, 1, 0, 2}, {0, 0, 1, 3}, {0, 0, 0, 1}}}, 0);
}

TEST(Transform, TranslateByValueList) {
  expectMatrix(transformOf(R"(<translate value="1, 2 3"/>)"),
               {{{1, 0, 0, 1}, {0, 1, 0, 2}, {0, 0, 1, 3}, {0, 0, 0, 1}}}, 0);
}

TEST(Transform, ScaleDefaultsToOnePerAxis) {
  expectMatrix(transformOf(R"(<scale y="2"/>)"), {{{1, 0, 0, 0}, {0, 2, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}, 0);
}

TEST(Transform, ScaleByOneValueIsUniform) {
  expectMatrix(transformOf(R"(<scale value="3"/>)"), {{{3, 0, 0, 0}, {0, 3, 0, 0}, {0, 0, 3, 0}, {0, 0, 0, 1}}}, 0);
}

TEST(Transform, RotateTurnsCounterClockwiseAboutItsAxis) {
  expectMatrix(transformOf(R"(<rotate z="1" angle="90"/>)"),
               {{{0, -1, 0, 0}, {1, 0, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}, kFewUlps);
  expectMatrix(transformOf(R"(<rotate x="1" angle="90"/>)"),
               {{{1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}, {0, 0, 0, 1}}}, kFewUlps);
}

TEST(Transform, RotateNormalisesItsAxis) {
  // 120 degrees about the diagonal permutes the axes.
  expectMatrix(transformOf(R"(<rotate x="5" y="5" z="5" angle="120"/>)"),
               {{{0, 0, 1, 0}, {1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 0, 1}}}, kFewUlps);
}

TEST(Transform, LookAtPutsLeftUpForward) {
  expectMatrix(transformOf(R"(<lookat origin="1,2,3" target="4,6,3" up="0,0,1"/>)"),
               {{{-0.8, 0, 0.6, 1}, {0.6, 0, 0.8, 2}, {0, 1, 0, 3}, {0, 0, 0, 1}}}, kFewUlps);
}

TEST(Transform, LookAtWithoutUpChoosesMitsubasOne) {
  expectMatrix(transformOf(R"(<lookat origin="1,2,3" target="4,6,9"/>)"),
               {{{0.111254, 0.91656, 0.384111, 1},
                 {-0.851662, -0.111254, 0.512148, 2},
                 {0.512148, -0.384111, 0.768221, 3},
                 {0, 0, 0, 1}}},
               kSixDigits);
}

TEST(Transform, MatrixOfSixteen) {
  expectMatrix(transformOf(R"(<matrix value="1 2 3 4  0 1 5 6  0 0 1 7  0 0 0 1"/>)"),
               {{{1, 2, 3, 4}, {0, 1, 5, 6}, {0, 0, 1, 7}, {0, 0, 0, 1}}}, 0);
}

TEST(Transform, MatrixOfNineIsTheLinearPart) {
  expectMatrix(transformOf(R"(<matrix value="1 2 3  0 1 5  0 0 1"/>)"),
               {{{1, 2, 3, 0}, {0, 1, 5, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}, 0);
}

TEST(Transform, OperationsApplyInTheOrderWritten) {
  expectMatrix(transformOf(R"(<translate x="1"/><scale value="2"/>)"),
               {{{2, 0, 0, 2}, {0, 2, 0, 0}, {0, 0, 2, 0}, {0, 0, 0, 1}}}, 0);
}

void expectTransformError(std::string_view operation, std::string_view text) {
  expectErrorOnLine2(
      "<shape type=\"sphere\"><transform name=\"to_world\">" + std::string(operation) + "</transform></shape>", text);
}

TEST(Transform, BadOperationsAreErrors) {
  expectTransformError(R"(<rotate x="1"/>)", "no angle");
  expectTransformError(R"(<rotate angle="5"/>)", "no direction");
  expectTransformError(R"(<lookat origin="0,0,0" target="0,0,0" up="0,1,0"/>)", "degenerate <lookat>");
  expectTransformError(R"(<lookat origin="0,0,0" target="0,1,0" up="0,1,0"/>)", "degenerate <lookat>");
  // Vectors whose cross product is rounding.
  expectTransformError(R"(<lookat origin="0,0,0" target="1,2,3" up="0.1,0.2,0.3"/>)", "degenerate <lookat>");
  expectTransformError(R"(<lookat origin="3,4,5" target="0,0,0" up="0.3,0.4,0.5"/>)", "degenerate <lookat>");
  expectTransformError(R"(<lookat origin="0,0" target="0,1,0"/>)", "2 numbers in \"0,0\"; expected 3");
  expectTransformError(R"(<lookat origin="0,0,0"/>)", "incomplete");
  expectTransformError(R"(<matrix value="1 2 3 4"/>)", "4 numbers in <matrix>; expected 16 or 9");
  expectTransformError(R"(<matrix value="1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1"/>)", "projective");
  expectTransformError(R"(<translate x="1" value="2"/>)", "both value and x, y, z");
  expectTransformError(R"(<translate value="1 2"/>)", "2 numbers in value");
  expectTransformError(R"(<shear x="1"/>)", "<shear> inside <transform>");
  expectTransformError(R"(<scale w="1"/>)", "unexpected attribute \"w\"");
  expectTransformError(R"(<scale value="1e300"/><scale value="1e300"/>)", "overflows");
}

}  // namespace
}  // namespace wavecrest
