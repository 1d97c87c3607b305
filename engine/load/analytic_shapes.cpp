// Readers of the shapes that need no file. In object space they are Mitsuba's: the rectangle is [-1, 1]^2 at z = 0
// facing +z, the disk has radius 1 and faces +z, the cube is [-1, 1]^3, the sphere has radius 1 about the origin.
#include <cmath>

#include "engine/load/mesh_build.h"
#include "engine/load/shapes.h"

namespace wavecrest {

namespace {

// Column j of the linear part, which is the image of axis j.
Double3 column(const Matrix4& m, size_t j) { return {m[0][j], m[1][j], m[2][j]}; }

// Whether the lengths of two vectors agree and the vectors are perpendicular, to within float rounding of the file.
bool isUniform(const Double3& a, const Double3& b) {
  constexpr double kTolerance = 1e-4;
  const double la = length(a), lb = length(b);
  return std::abs(la - lb) <= kTolerance * la && std::abs(dot(a, b)) <= kTolerance * la * lb;
}

// Orthonormal s, t with s x t = n (Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017).
void basisAround(const Double3& n, Double3& s, Double3& t) {
  const double sign = std::copysign(1.0, n[2]), a = -1 / (sign + n[2]), b = n[0] * n[1] * a;
  s = {1 + sign * n[0] * n[0] * a, sign * b, -sign * n[0]};
  t = {b, sign + n[1] * n[1] * a, -n[1]};
}

}  // namespace

Rectangle placeRectangle(const Matrix4& toWorld, bool flipNormals) {
  Rectangle rectangle{.corner = transformPoint(toWorld, {-1, -1, 0}),
                      .edgeU = transformVector(toWorld, {2, 0, 0}),
                      .edgeV = transformVector(toWorld, {0, 2, 0})};
  // The normal is to_world's image of +z as a normal, whatever the handedness: edgeU is reversed to face that way.
  const bool mirrored = determinant3(toWorld) < 0;
  if (mirrored != flipNormals) {
    rectangle.corner = rectangle.corner + rectangle.edgeU;
    rectangle.edgeU = -1 * rectangle.edgeU;
    rectangle.mirrored = true;
  }
  return rectangle;
}

Geometry readRectangle(LoadContext&, Parameters& parameters, const Matrix4& toWorld) {
  return placeRectangle(toWorld, parameters.boolean("flip_normals", false));
}

Geometry readDisk(LoadContext& context, Parameters& parameters, const Matrix4& toWorld) {
  Disk disk{.center = transformPoint(toWorld, {0, 0, 0}), .axisU = column(toWorld, 0), .axisV = column(toWorld, 1)};
  if (std::abs(dot(disk.axisU, disk.axisV)) > 1e-4 * length(disk.axisU) * length(disk.axisV)) {
    context.unsupported(parameters.locationOf("to_world"),
                        "sheared disk is not supported; expected perpendicular axes");
  }
  const bool mirrored = determinant3(toWorld) < 0;
  if (mirrored != parameters.boolean("flip_normals", false)) {
    // As for the rectangle: one axis is reversed, so that the front is on the right side.
    disk.axisV = -1 * disk.axisV;
    disk.mirrored = true;
  }
  return disk;
}

Geometry readSphere(LoadContext& context, Parameters& parameters, const Matrix4& toWorld) {
  Double3 center = parameters.vector("center").value_or(Double3{0, 0, 0});
  const double radius = parameters.positiveReal("radius", 1);
  const Double3 x = column(toWorld, 0), y = column(toWorld, 1), z = column(toWorld, 2);
  // The image must be a sphere.
  if (!isUniform(x, y) || !isUniform(x, z) || !isUniform(y, z)) {
    context.unsupported(parameters.locationOf("to_world"),
                        "sphere scaled differently along its axes; expected a uniform scale (or a mesh)");
  }
  // In files of 0.4 to 0.6 to_world scales the radius, and not the center.
  const bool legacy = parameters.object().legacy;
  if (legacy && length(x) > 0) center = (1 / length(x)) * center;
  // A mirroring transform turns a sphere inside out, in Mitsuba 3 as here; in 0.6 normals point away from the center.
  const bool mirrored = !legacy && determinant3(toWorld) < 0;
  return Sphere{.center = transformPoint(toWorld, center),
                .radius = radius * length(x),
                .flipNormals = mirrored != parameters.boolean("flip_normals", false),
                .toWorld = multiply(toWorld, multiply(translation(center), scaling({radius, radius, radius})))};
}

namespace {

// The images of the cylinder's axis and of the two directions across it where phi is 0 and pi / 2.
struct CylinderFrame {
  Double3 phi0{}, phi90{}, axis{};
};

CylinderFrame frameOf(const Matrix4& toWorld, const Double3& p0, const Double3& p1) {
  const Double3 axis = normalized(p1 - p0);
  Double3 s, t;
  basisAround(axis, s, t);
  return {transformVector(toWorld, s), transformVector(toWorld, t), transformVector(toWorld, axis)};
}

}  // namespace

// Assumes that the image is a circular cylinder, which readCylinder checks.
Cylinder placeCylinder(const Matrix4& toWorld, const Double3& p0, const Double3& p1, double radius, bool flipNormals) {
  // Normals point away from the axis in the mirror, too, as in Mitsuba 3.
  const CylinderFrame frame = frameOf(toWorld, p0, p1);
  return {.p0 = transformPoint(toWorld, p0),
          .p1 = transformPoint(toWorld, p1),
          .radius = radius * length(frame.phi0),
          .flipNormals = flipNormals,
          .phi0 = normalized(frame.phi0),
          .phi90 = normalized(frame.phi90)};
}

Geometry readCylinder(LoadContext& context, Parameters& parameters, const Matrix4& toWorld) {
  const Double3 p0 = parameters.vector("p0").value_or(Double3{0, 0, 0});
  const Double3 p1 = parameters.vector("p1").value_or(Double3{0, 0, 1});
  const double radius = parameters.positiveReal("radius", 1);
  if (!(length(p1 - p0) > 0) || !std::isfinite(length(p1 - p0))) {
    throw LoadError(parameters.locationOf("p1"), "cylinder has no length; expected p0 and p1 to differ");
  }
  // The image must be a circular cylinder: u and v have one length, and both are perpendicular to the axis w.
  const auto [u, v, w] = frameOf(toWorld, p0, p1);
  constexpr double kTolerance = 1e-4;
  const bool straight = std::abs(dot(u, w)) <= kTolerance * length(u) * length(w) &&
                        std::abs(dot(v, w)) <= kTolerance * length(v) * length(w);
  if (!isUniform(u, v) || !straight) {
    context.unsupported(parameters.locationOf("to_world"),
                        "cylinder with an elliptic or slanted section; expected a uniform scale around its axis");
  }
  // In files of 0.4 to 0.6 normals of a mirrored cylinder point inward.
  const bool inward = parameters.object().legacy && determinant3(toWorld) < 0;
  return placeCylinder(toWorld, p0, p1, radius, inward != parameters.boolean("flip_normals", false));
}

// Four vertices per face, so that each has its own texture coordinates; faces in Mitsuba's order -y +y +x +z -x -z.
Geometry readCube(LoadContext& context, Parameters& parameters, const Matrix4& toWorld) {
  static constexpr int kCorners[6][4][3] = {
      {{1, -1, -1}, {1, -1, 1}, {-1, -1, 1}, {-1, -1, -1}}, {{1, 1, -1}, {-1, 1, -1}, {-1, 1, 1}, {1, 1, 1}},
      {{1, -1, -1}, {1, 1, -1}, {1, 1, 1}, {1, -1, 1}},     {{1, -1, 1}, {1, 1, 1}, {-1, 1, 1}, {-1, -1, 1}},
      {{-1, -1, 1}, {-1, 1, 1}, {-1, 1, -1}, {-1, -1, -1}}, {{1, 1, -1}, {1, -1, -1}, {-1, -1, -1}, {-1, 1, -1}}};
  static constexpr Float2 kUvs[4] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  TriangleSoup soup;
  // Two triangles for each face.
  for (uint32_t face = 0; face < 6; ++face) {
    for (size_t i = 0; i < 4; ++i) {
      const auto& c = kCorners[face][i];
      soup.positions.push_back({static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2])});
      soup.uvs.push_back(kUvs[i]);
    }
    const uint32_t v = 4 * face;
    soup.triangles.push_back({v, v + 1, v + 2});
    soup.triangles.push_back({v + 3, v, v + 2});
  }
  MeshPlacement placement{.toWorld = toWorld, .faceNormals = true};
  // Mitsuba gives the cube outward normals of its own, which a mirroring transform leaves outward.
  placement.flipNormals = parameters.boolean("flip_normals", false) != (determinant3(toWorld) < 0);
  parameters.ignore({"face_normals"});  // it has them anyway
  return buildMesh(context, std::move(soup), placement, parameters.location());
}

}  // namespace wavecrest
