// Lathe, tube, teapots and water: closed where they must be, facing outwards, with normals that belong to the surface.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>

#include "scenes/generate/lathe.h"
#include "scenes/generate/teapot.h"
#include "scenes/generate/tube.h"
#include "scenes/generate/water.h"
#include "tests/scenes/mesh_checks.h"

namespace wavecrest::generate {
namespace {

TEST(Lathe, TurnsAHalfCircleIntoASphere) {
  std::vector<ProfilePoint> profile;
  constexpr int kSteps = 64;
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = std::numbers::pi * (static_cast<double>(i) / kSteps - 0.5);
    const bool pole = i == 0 || i == kSteps;
    profile.push_back({pole ? 0 : std::cos(angle), std::sin(angle), pole ? 0 : std::cos(angle), std::sin(angle)});
  }
  Mesh mesh;
  appendLathe(mesh, profile, 128);
  EXPECT_EQ(openEdges(mesh), 0);
  // The inscribed polyhedron is smaller by (2 pi / 128)^2 / 6 for the turning and (pi / 64)^2 / 4 for the profile: 0.10
  // %.
  EXPECT_NEAR(signedVolume(mesh) / (4 * std::numbers::pi / 3), 1 - 0.0010, 0.0002);
  EXPECT_GT(worstNormalAgreement(mesh), 0.999);
}

TEST(Lathe, SmoothProfilePassesThroughItsPointsAndMeetsTheAxisAtARightAngle) {
  const std::array<double, 2> points[] = {{0, 0}, {1, 0.2}, {0.8, 1}, {0, 1.5}};
  constexpr int kSteps = 8;
  const std::vector<ProfilePoint> profile = smoothProfile(points, kSteps);
  ASSERT_EQ(profile.size(), 3u * kSteps + 1);
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(profile[i * kSteps].radius, points[i][0], 1e-12);
    EXPECT_NEAR(profile[i * kSteps].height, points[i][1], 1e-12);
  }
  EXPECT_EQ(profile.front().normalHeight, -1);
  EXPECT_EQ(profile.back().normalHeight, 1);
}

TEST(Lathe, ConeFacesOutwardsAndIsOpen) {
  const Mesh cone = makeCone(0.1, 0.3, 0.5, 40);
  EXPECT_EQ(openEdges(cone), 80);
  EXPECT_GT(worstNormalAgreement(cone), 0.99);
  for (size_t i = 0; i < cone.positions.size(); ++i)
    EXPECT_GT(cone.normals[i][0] * cone.positions[i][0] + cone.normals[i][2] * cone.positions[i][2], 0);
}

TEST(Tube, StraightTubeIsAClosedCylinder) {
  const Tube tube{{{{0, 0}, {1, 0}, {2, 0}, {3, 0}}}, 0.5, 0.5};
  Mesh mesh;
  appendTube(mesh, tube, 12, 64);
  EXPECT_EQ(openEdges(mesh), 0);
  EXPECT_NEAR(signedVolume(mesh), std::numbers::pi * 0.25 * 3, 0.01);
  EXPECT_GT(worstNormalAgreement(mesh), 0.99);
}

TEST(Tube, BentCapGoesWhereAdvanceSends) {
  const Tube tube{{{{0, 0}, {1, 0}, {2, 0}, {3, 0}}}, 0.5, 0.5};
  Mesh mesh;
  // A cap that bulges to the sphere of radius 4 around the origin.
  appendTube(mesh, tube, 12, 64, nullptr,
             [](const Vec3& p, const Vec3&) { return std::sqrt(16 - p[1] * p[1] - p[2] * p[2]) - p[0]; });
  EXPECT_EQ(openEdges(mesh), 0);
  // The last ring of the side, eight rings of the cap, and its middle.
  EXPECT_EQ(std::count_if(mesh.positions.begin(), mesh.positions.end(),
                          [](const Vec3& p) { return std::abs(length(p) - 4) < 1e-12; }),
            64 + 8 * 64 + 1);
}

TEST(Teapot, OpaquePotIsMadeOfClosedPiecesThatFaceOutwards) {
  const Mesh pot = makeOpaqueTeapot();
  EXPECT_EQ(openEdges(pot), 0);
  EXPECT_GT(signedVolume(pot), 0.01);
  EXPECT_GT(worstNormalAgreement(pot), 0.9);
  EXPECT_LT(worstNormalLength(pot), 1e-9);
}

TEST(Teapot, StandsOnTheGround) {
  for (const Mesh& pot : {makeOpaqueTeapot(), makeGlassTeapot()}) {
    double lowest = 1;
    for (const Vec3& p : pot.positions) lowest = std::min(lowest, p[1]);
    EXPECT_EQ(lowest, 0);
  }
}

TEST(Teapot, GlassPotIsWatertightAndHollow) {
  const Mesh pot = makeGlassTeapot();
  EXPECT_EQ(openEdges(pot), 0);
  EXPECT_LT(signedVolume(pot), 0.25 * signedVolume(makeOpaqueTeapot()));
  EXPECT_GT(signedVolume(pot), 0);
  EXPECT_GT(worstNormalAgreement(pot), 0.9);
}

// Labels each vertex with a representative of its connected piece.
std::vector<size_t> connectedPieces(const Mesh& mesh) {
  std::vector<size_t> piece(mesh.positions.size());
  for (size_t i = 0; i < piece.size(); ++i) piece[i] = i;
  const auto root = [&](size_t i) {
    while (piece[i] != i) i = piece[i] = piece[piece[i]];
    return i;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    piece[root(a)] = root(b);
    piece[root(b)] = root(c);
  }
  for (size_t i = 0; i < piece.size(); ++i) piece[i] = root(i);
  return piece;
}

TEST(Teapot, GlassHandleAndSpoutDoNotTouchTheBody) {
  const Mesh pot = makeGlassTeapot();
  const std::vector<size_t> piece = connectedPieces(pot);
  const size_t body = piece[0];  // the outer surface is built first
  // Outside the body: beyond its radius, or on its axis-symmetric hull's outer side by the vertex normals of the body.
  int near = 0;
  for (size_t i = 0; i < piece.size(); ++i) {
    if (piece[i] == body || std::abs(pot.positions[i][0]) < 0.13) continue;  // the body itself; the cavity's middle
    double nearest = std::numeric_limits<double>::max();
    size_t closest = 0;
    for (size_t j = 0; j < piece.size(); ++j) {
      const double distance = piece[j] == body ? length(pot.positions[i] - pot.positions[j]) : 1;
      if (distance < nearest) nearest = distance, closest = j;
    }
    const double outside = dot(pot.positions[i] - pot.positions[closest], pot.normals[closest]);
    if (std::abs(outside + 0.006) < 0.001) continue;  // the cavity, a wall's thickness inside
    ASSERT_GT(outside, 0.0001);
    near += outside < 0.001;
  }
  EXPECT_GT(near, 500);  // three caps follow the body closely
}

TEST(Water, SlopesAreTheDerivativesOfTheHeight) {
  constexpr double kStep = 1e-5;
  for (const auto& [x, z] : {std::pair{0.3, -1.1}, {2.7, 0.4}, {-3.9, 2.2}}) {
    const WaterSample here = sampleWater(x, z);
    EXPECT_NEAR(here.slopeX, (sampleWater(x + kStep, z).height - sampleWater(x - kStep, z).height) / (2 * kStep), 1e-8);
    EXPECT_NEAR(here.slopeZ, (sampleWater(x, z + kStep).height - sampleWater(x, z - kStep).height) / (2 * kStep), 1e-8);
  }
}

TEST(Water, MeshLiesOnTheWavesAndFacesUp) {
  const Mesh water = makeWater({.halfX = 4, .halfZ = 2.5, .cellsX = 320, .cellsZ = 200});
  EXPECT_EQ(water.triangles.size(), 2u * 320 * 200);
  EXPECT_GT(worstNormalAgreement(water), 0.99);
  double slopeSquared = 0;
  for (size_t i = 0; i < water.positions.size(); ++i) {
    const WaterSample sample = sampleWater(water.positions[i][0], water.positions[i][2]);
    ASSERT_EQ(water.positions[i][1], sample.height);
    ASSERT_GT(water.normals[i][1], 0.9);
    slopeSquared += sample.slopeX * sample.slopeX + sample.slopeZ * sample.slopeZ;
  }
  EXPECT_NEAR(std::sqrt(slopeSquared / static_cast<double>(water.positions.size())), 0.096, 0.01);
}

}  // namespace
}  // namespace wavecrest::generate
