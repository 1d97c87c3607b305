// Round tubes along planar cubic Bezier curves: handle and spout of a teapot.
#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "scenes/generate/mesh.h"

namespace wavecrest::generate {

// The curve lies in the plane z = 0; the radius changes linearly from start to end.
struct Tube {
  std::array<std::array<double, 2>, 4> controls{};
  double startRadius = 0, endRadius = 0;
  double from = 0, to = 1;  // part of the curve that is built
};

// Where and how a tube ends. A cap's vertices can be moved along the tube's direction, so that it follows the surface
// that the tube is set against; `advance` gets a vertex and the direction outwards and returns how far to move it.
using Advance = std::function<double(const Vec3& position, const Vec3& outwards)>;

Vec3 tubeCenter(const Tube& tube, double t);
Vec3 tubeDirection(const Tube& tube, double t);  // unit, towards the end
double tubeRadius(const Tube& tube, double t);

// Appends the closed tube: side, then a cap at either end. A null Advance leaves the cap flat.
void appendTube(Mesh& mesh, const Tube& tube, uint32_t steps, uint32_t segments, const Advance& startCap = nullptr,
                const Advance& endCap = nullptr);

}  // namespace wavecrest::generate
