// Small scenes for the sweeps, put together in code: a box with a lamp, and enclosures whose every pixel is known.
#pragma once

#include "engine/scene/scene.h"

namespace wavecrest {

constexpr uint32_t kExtremeSide = 12;  // pixels of a film

// Side 2 around `center` times `size`, with a lamp below its ceiling and a sphere; the camera is within.
struct BoxOptions {
  double size = 1;
  Double3 center{};
  double lampSide = 0.5;    // of the box's side 2
  double lampRadiance = 4;  // of a lamp of side 0.5; smaller ones have the same power
  bool sphere = true;
};
Scene lampBox(const BoxOptions& options);

// A closed room of side 2 whose walls reflect `albedo` and all emit 1: 1 / (1 - albedo) is seen everywhere.
Scene shiningRoom(double albedo, double fov = 70);
// The same beside another room, out of sight, whose walls emit `ratio`.
Scene besideBrightRoom(double albedo, double ratio);
// The same seen from this far before the middle of its back wall.
Scene closeToWall(double albedo, double distance);
// The same seen towards a corner of it, through this field of view.
Scene roomCorner(double albedo, double fov);

// A sphere of the material under a sky of radiance 1; and seen from its centre.
Scene skySphere(const Material& material);
Scene withinSphere(const Material& material);
// A square of the material under that sky, seen straight from above.
Scene skySquare(const Material& material);

// Concentric glass spheres, `shells` of them, under a sky of radiance 1: 1 is seen everywhere.
Scene nestedGlass(uint32_t shells);

// A white floor of side 2 under a light of the intensity that gives it, straight below, an irradiance of pi; seen from
// above by parallel rays.
Scene litFloor(double lightDistance, double lightRadius);

// A white floor under a spot at distance 1, straight above, whose intensity falls off from pi on the axis to 0 at the
// cutoff (degrees); seen from above by parallel rays, as far as it is lit.
Scene spotFloor(double cutoff);

// A floor of albedo 0.5 under a sky that is black but for the upper of its rows, so bright that 0.5 is seen.
Scene polarSky(uint32_t rows);

// A floor of albedo 0.5 under a sky of radiance 1, seen by parallel rays at `angle` to it.
Scene grazedFloor(double angle);
// The same from above, made of triangles of this aspect, with triangles without area and a second floor in its plane.
Scene sliverFloor(double aspect);

// A diffuse sphere under a sky that is black but for one texel.
Scene hotSky(double brightness);

}  // namespace wavecrest
