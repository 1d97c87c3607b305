// Sweeps over lights.
#include "bench/extremes/extreme_scenes.h"
#include "bench/extremes/sweep_parts.h"

namespace wavecrest {
namespace {

// All methods but those that merge alone.
const std::vector<Method> kUnbiased{Method::pt, Method::lt, Method::bpt, Method::mlt, Method::vcm, Method::gpt};
constexpr const char* kNoPhotonsAlone = "ppm, bpm: a disc of photons reaches beyond the edges of walls, a bias of 3 %";

// Sizes, distances and angles of lights.
void addExtents(std::vector<Sweep>& out) {
  out.push_back({.name = "lamp-size",
                 .title = "A box with a square lamp of constant power",
                 .xLabel = "side of the lamp in half sides of the box",
                 .values = {1e-2, 1e-4, 1e-5, 1e-6},
                 .scene = [](double x) { return lampBox({.lampSide = x}); },
                 .baseline = 1e-3,
                 .bound = 2e-3,
                 .boundSource = "the same seeds at 1e-3, which is a point but for its squared size",
                 .methods = kEveryMethod,
                 .adjust =
                     [](double, RenderSettings& settings) {
                       if (settings.method != Method::ppm && settings.method != Method::bpm) return;
                       settings.radius = 0.05;  // a lamp's rays move by its size, and must stay within most discs
                       settings.lightPaths = 4096;
                     }});
  // The lamp's radiance grows as the square of its radius shrinks (litFloor).
  out.push_back({.name = "sphere-light-size",
                 .title = "A floor under a spherical lamp of constant power, straight above",
                 .xLabel = "radius at distance 2",
                 .values = {1e-2, 1e-4, 1e-5, 1e-6, 1e-7},
                 .scene = [](double x) { return litFloor(2, x); },
                 .baseline = 0.1,
                 .bound = 1e-4,
                 .boundSource = "a sphere that is seen whole lights as a point does, whatever its radius",
                 .methods = {Method::pt, Method::bpt, Method::vcm},
                 .leftOut = "lt, ppm, bpm, mlt: few light paths reach the part that is seen",
                 .everyRun = true});
  // The light's intensity grows with the square of its distance (litFloor).
  out.push_back({.name = "light-distance",
                 .title = "A floor under a point light at constant irradiance",
                 .xLabel = "distance in half sides of the floor",
                 .values = {1e2, 1e4, 1e6},
                 .scene = [](double x) { return litFloor(x, 0); },
                 .truth = [](double) { return 1.0; },
                 .bound = 1e-4,
                 .boundSource = "intensity over squared distance; off the foot by squared size over distance",
                 .methods = {Method::pt, Method::bpt, Method::vcm, Method::mlt},
                 .leftOut = "lt, ppm, bpm: next to none of the light's paths reach the floor"});
  out.push_back(
      {.name = "spot-cutoff",
       .title = "A floor under a narrow spot, straight above",
       .xLabel = "angle of the cutoff in degrees",
       .values = {1, 0.1, 1e-2},
       .scene = spotFloor,
       .baseline = 0.5,
       .bound = 2e-3,
       .boundSource = "the same seeds at 0.5 degrees; cosines differ by the squared angle, roundings by 1e-7 over it",
       .methods = {Method::pt, Method::lt, Method::bpt},
       .leftOut = "vcm, ppm, bpm: discs of photons are wider than the beam; mlt: chains make the paths of bpt",
       .samples = samples(256),
       .everyRun = true});
}

// How bright they are.
void addRadiances(std::vector<Sweep>& out) {
  // Directions to within a row of the pole have a vertical part that rounds to 1.
  out.push_back({.name = "sky-pole",
                 .title = "A floor under a sky that is black but for the row at its pole",
                 .xLabel = "rows of the sky",
                 .values = {128, 1024, 8192},
                 .scene = [](double x) { return polarSky(static_cast<uint32_t>(x)); },
                 .truth = [](double) { return 0.5; },
                 .bound = 1e-3,
                 .boundSource = "the irradiance of a small cone, to the fifth of its squared angle",
                 .methods = {Method::pt, Method::lt, Method::bpt},
                 .leftOut = "vcm, ppm, bpm: discs reach beyond the floor; mlt: chains make the paths of bpt",
                 .samples = samples(256),
                 .everyRun = true});
  // Rows are divided by their value, so all must be equal.
  out.push_back({.name = "brightness",
                 .title = "A box with a lamp of this radiance",
                 .xLabel = "radiance",
                 .values = {1e-12, 1e-6, 1, 1e6, 1e12},
                 .scene = [](double x) { return lampBox({.lampRadiance = 4 * x}); },
                 .scale = [](double x) { return x; },
                 .bound = 2e-6,
                 .boundSource = "the same seeds at 1: all is linear in radiance, so rounding alone differs",
                 .methods = kEveryMethod});
  // At large ratios the other room has nearly all of the power. A choice of lights by power alone would hardly ever
  // pick a light in view.
  out.push_back({.name = "brightness-ratio",
                 .title = "A shining room beside another, out of sight, whose walls emit this much more",
                 .xLabel = "ratio",
                 .values = {1, 1e4, 1e8, 1e12},
                 .scene = [](double x) { return besideBrightRoom(0.5, x); },
                 .truth = [](double) { return 2.0; },
                 .bound = 1e-3,
                 .boundSource = "1 / (1 - albedo); half of all picks goes to all emitters alike, of pt an eighth",
                 .methods = {Method::pt, Method::lt, Method::bpt},
                 .leftOut = "vcm, ppm, bpm: a bias of 3 %; mlt: its bootstrap sees the camera's room alone",
                 .samples = samples(64)});
  // All light comes from one of the 128 texels of the sky.
  out.push_back({.name = "hot-texel",
                 .title = "A sphere under a sky that is black but for one texel",
                 .xLabel = "radiance of the texel",
                 .values = {1, 1e4, 1e8},
                 .scene = hotSky,
                 .against = Method::pt,
                 .bound = 2e-3,
                 .boundSource = "path tracing in double",
                 .methods = kUnbiased,
                 .leftOut = kNoPhotonsAlone,
                 .samples = samples(256),
                 .resolution = 0.03});
}

}  // namespace

void addLightSweeps(std::vector<Sweep>& out) {
  addExtents(out);
  addRadiances(out);
}

}  // namespace wavecrest
