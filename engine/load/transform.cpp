#include "engine/load/transform.h"

#include <algorithm>
#include <cmath>

#include "engine/load/values.h"

namespace wavecrest {

void checkAttributes(const XmlElement& element, std::initializer_list<std::string_view> known) {
  for (const auto& [name, value] : element.attributes) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    std::string list;
    for (const std::string_view attribute : known) list += (list.empty() ? "" : ", ") + std::string(attribute);
    throw LoadError(element.location(),
                    "unexpected attribute \"" + name + "\" of <" + element.tag + ">; expected " + list);
  }
}

Double3 readVectorAttributes(const XmlElement& element, double fallback) {
  const SourceLocation where = element.location();
  const std::string* const xyz[3] = {element.find("x"), element.find("y"), element.find("z")};
  // The attribute `value` has one number for all components, or three.
  if (const std::string* value = element.find("value")) {
    if (xyz[0] || xyz[1] || xyz[2]) {
      throw LoadError(where, "<" + element.tag + "> has both value and x, y, z; expected one of the two");
    }
    const std::vector<double> values = parseReals(*value, where);
    if (values.size() == 1) return {values[0], values[0], values[0]};
    if (values.size() == 3) return {values[0], values[1], values[2]};
    throw LoadError(where,
                    std::to_string(values.size()) + " numbers in value " + inQuotes(*value) + "; expected 1 or 3");
  }
  Double3 vector{fallback, fallback, fallback};
  for (size_t i = 0; i < 3; ++i) {
    if (xyz[i]) vector[i] = parseReal(*xyz[i], where);
  }
  return vector;
}

namespace {

// A rotation by `angle` degrees about the axis x, y, z, which need not have unit length.
Matrix4 readRotate(LoadContext& context, const XmlElement& element) {
  checkAttributes(element, {"angle", "x", "y", "z", "value"});
  const std::string* angle = element.find("angle");
  if (!angle) throw LoadError(element.location(), "<rotate> has no angle; expected degrees");
  const Double3 axis = readVectorAttributes(element, 0);
  if (!(length(axis) > 0) || !std::isfinite(length(axis))) {
    throw LoadError(element.location(), "rotation axis has no direction; expected x, y, z not all zero");
  }
  // A unit axis that the file rounds to a few digits deserves no note.
  constexpr double kRoundedDigits = 1e-3;
  if (std::abs(length(axis) - 1) > kRoundedDigits) {
    context.note(element.location(), "rotation about an axis of another length than 1",
                 "its direction counts, where Mitsuba 3 shears");
  }
  return rotation(axis, parseReal(*angle, element.location()));
}

// See lookAt in matrix.h. Without `up`, the camera may have any rotation about its axis.
Matrix4 readLookAt(const XmlElement& element) {
  checkAttributes(element, {"origin", "target", "up"});
  const SourceLocation where = element.location();
  const std::string *origin = element.find("origin"), *target = element.find("target"), *up = element.find("up");
  if (!origin || !target) {
    throw LoadError(where, "<" + element.tag + "> is incomplete; expected the attributes origin and target");
  }
  const Double3 from = parseTriple(*origin, where), to = parseTriple(*target, where);
  const Double3 d = normalized(to - from);
  Double3 upward = up ? parseTriple(*up, where) : Double3{0, 0, 0};
  if (upward == Double3{0, 0, 0}) {
    // Any direction across the view axis: the one Duff et al. (2017, "Building an Orthonormal Basis, Revisited") give.
    const double sign = std::copysign(1.0, d[2]), a = -1 / (sign + d[2]), b = d[0] * d[1] * a;
    upward = {1 + sign * d[0] * d[0] * a, sign * b, -sign * d[0]};
  }
  // A sine this small between `up` and the view is rounding. If `target` equals `origin`, it is not a number.
  constexpr double kResidue = 1e-10;
  if (!(length(cross(upward, d)) > kResidue * length(upward))) {
    throw LoadError(where, "degenerate <" + element.tag + ">; expected target unlike origin and up not along the view");
  }
  return lookAt(from, to, upward);
}

// 16 numbers, or 9 that are the linear part.
Matrix4 readMatrix(const XmlElement& element) {
  checkAttributes(element, {"value"});
  const SourceLocation where = element.location();
  const std::vector<double> values = parseReals(element.get("value"), where);
  if (values.size() != 16 && values.size() != 9) {
    throw LoadError(where, std::to_string(values.size()) + " numbers in <matrix>; expected 16 or 9, row by row");
  }
  // With 9 numbers, the rest is that of the identity.
  const size_t n = values.size() == 16 ? 4 : 3;
  Matrix4 m = identityMatrix();
  for (size_t i = 0; i < n; ++i) {
    for (size_t j = 0; j < n; ++j) m[i][j] = values[i * n + j];
  }
  // Transforms of points in this loader assume an affine matrix.
  if (m[3] != std::array<double, 4>{0, 0, 0, 1}) {
    throw LoadError(where, "<matrix> is projective; expected a last row of 0 0 0 1");
  }
  return m;
}

// The matrix of one child of <transform>.
Matrix4 readOperation(LoadContext& context, const XmlElement& element) {
  if (element.tag == "translate") {
    checkAttributes(element, {"x", "y", "z", "value"});
    return translation(readVectorAttributes(element, 0));
  }
  if (element.tag == "scale") {
    checkAttributes(element, {"x", "y", "z", "value"});
    return scaling(readVectorAttributes(element, 1));
  }
  if (element.tag == "rotate") return readRotate(context, element);
  if (element.tag == "lookat" || element.tag == "look_at") return readLookAt(element);
  if (element.tag == "matrix") return readMatrix(element);
  throw LoadError(element.location(),
                  "<" + element.tag + "> inside <transform>; expected translate, rotate, scale, lookat or matrix");
}

}  // namespace

Matrix4 readTransform(LoadContext& context, const XmlElement& transform) {
  checkAttributes(transform, {"name"});
  Matrix4 m = identityMatrix();
  // Multiply from the left: the first operation of the file is the first to be applied.
  for (const XmlElement& operation : transform.children) m = multiply(readOperation(context, operation), m);
  if (!isFinite(m)) throw LoadError(transform.location(), "transform overflows; expected finite entries");
  return m;
}

}  // namespace wavecrest
