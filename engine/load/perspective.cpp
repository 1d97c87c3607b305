#include "engine/load/perspective.h"

#include <cmath>
#include <numbers>

#include "engine/load/values.h"

namespace wavecrest {

namespace {

// How the field of view is given; it needs the film's aspect ratio to become horizontal.
struct FieldOfView {
  double degrees = 0;
  std::string axis;
  SourceLocation where;
};

double toRadians(double degrees) { return degrees * (std::numbers::pi / 180); }
double toDegrees(double radians) { return radians * (180 / std::numbers::pi); }

// `fov` along `fov_axis`, or `focal_length`. LoadError if both are given.
FieldOfView readFieldOfView(Parameters& parameters) {
  FieldOfView fov{.axis = toLower(parameters.string("fov_axis", "x")), .where = parameters.location()};
  const bool hasFov = parameters.has("fov"), hasFocalLength = parameters.has("focal_length");
  if (hasFov && hasFocalLength) {
    throw LoadError(parameters.locationOf("focal_length"), "sensor has fov and focal_length; expected one of the two");
  }
  if (hasFov) {
    fov.degrees = parameters.requiredReal("fov");
    fov.where = parameters.locationOf("fov");
    return fov;
  }
  // A focal length refers to the diagonal of 35 mm film, 36 x 24 mm.
  std::string text = parameters.string("focal_length", "50mm");
  fov.where = parameters.locationOf("focal_length");
  if (text.ends_with("mm")) text.resize(text.size() - 2);
  const double focalLength = parseReal(text, fov.where);
  if (!(focalLength > 0)) throw LoadError(fov.where, "focal_length is not positive; expected for example 50mm");
  fov.degrees = 2 * toDegrees(std::atan(std::hypot(36.0, 24.0) / (2 * focalLength)));
  fov.axis = "diagonal";
  return fov;
}

// The field of view in degrees along the x axis of a picture. `aspect` is width over height.
double horizontalFov(const FieldOfView& fov, double aspect) {
  // Which side is smaller depends on the picture.
  std::string axis = fov.axis;
  if (axis == "smaller") axis = aspect > 1 ? "y" : "x";
  if (axis == "larger") axis = aspect > 1 ? "x" : "y";
  if (!(fov.degrees > 0) || !(fov.degrees < 180)) {
    throw LoadError(fov.where,
                    "field of view is " + std::to_string(fov.degrees) + "; expected degrees between 0 and 180");
  }
  // Half of the picture along the axis, at distance 1 from the pinhole.
  const double halfSize = std::tan(0.5 * toRadians(fov.degrees));
  if (axis == "x") return fov.degrees;
  if (axis == "y") return 2 * toDegrees(std::atan(halfSize * aspect));
  // A picture of width w has a diagonal of w sqrt(1 + 1 / aspect^2).
  if (axis == "diagonal") return 2 * toDegrees(std::atan(halfSize / std::sqrt(1 + 1 / (aspect * aspect))));
  throw LoadError(fov.where, "unknown fov_axis " + inQuotes(axis) + "; expected x, y, diagonal, smaller or larger");
}

}  // namespace

double readHorizontalFov(Parameters& parameters, double aspect) {
  return horizontalFov(readFieldOfView(parameters), aspect);
}

void checkRigid(const Matrix4& m, std::string_view whose, const SourceLocation& where) {
  // The rows of a rotation are orthonormal. The tolerance leaves room for rounded numbers in the file.
  constexpr double kTolerance = 1e-3;
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = i; j < 3; ++j) {
      double product = 0;
      for (size_t k = 0; k < 3; ++k) product += m[i][k] * m[j][k];
      if (std::abs(product - (i == j ? 1 : 0)) > kTolerance) {
        throw LoadError(where,
                        "to_world of " + std::string(whose) + " scales or shears; expected rotation and translation");
      }
    }
  }
}

void checkPerpendicular(const Matrix4& m, std::string_view whose, const SourceLocation& where) {
  // The columns are the images of the axes: none may be zero, and any two must be perpendicular. The tolerance leaves
  // room for rounded numbers in the file.
  constexpr double kTolerance = 1e-4;
  const auto product = [&](size_t i, size_t j) { return m[0][i] * m[0][j] + m[1][i] * m[1][j] + m[2][i] * m[2][j]; };
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = i; j < 3; ++j) {
      const bool perpendicular = std::abs(product(i, j)) <= kTolerance * std::sqrt(product(i, i) * product(j, j));
      if (i == j ? !(product(i, i) > 0) : !perpendicular) {
        throw LoadError(where, "to_world of " + std::string(whose) +
                                   " shears or flattens; expected rotation, translation and scale");
      }
    }
  }
}

}  // namespace wavecrest
