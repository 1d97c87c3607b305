// The sweeps themselves: each names what it varies, what the answer is, and where its bound comes from.
#include <fmt/core.h>

#include <cmath>

#include "bench/extremes/extreme_scenes.h"
#include "bench/extremes/sweep.h"

namespace wavecrest {
namespace {

const std::vector<Method> kEveryMethod{Method::pt,  Method::lt,  Method::bpt, Method::mlt,
                                       Method::ppm, Method::bpm, Method::vcm, Method::gpt};
// All methods but those that merge alone.
const std::vector<Method> kUnbiased{Method::pt, Method::lt, Method::bpt, Method::mlt, Method::vcm, Method::gpt};
constexpr const char* kNoPhotonsAlone = "ppm, bpm: a disc of photons reaches beyond the edges of walls, a bias of 3 %";

// A metal that absorbs nothing.
Material conductor(double alpha, Distribution distribution) {
  Material material;
  material.kind = Conductor{.perfectMirror = true, .alpha = {alpha}, .distribution = distribution};
  return material;
}
// Glass in air. alpha 0 is smooth.
Material glass(double ior, double alpha = 0, bool thin = false) {
  Material material;
  material.kind = Dielectric{.intIor = ior, .extIor = 1, .alpha = {alpha}, .thin = thin};
  return material;
}

// The same number of samples per pixel for all values.
std::function<uint64_t(double)> samples(uint64_t count) {
  return [count](double) { return count; };
}

// ---- size, place and precision of geometry --------------------------------------------------------------------------

void addGeometry(std::vector<Sweep>& out) {
  // Intersectors round differently, so each has its own sweeps of scale and place.
  for (const Accel accel : {Accel::small, Accel::bvh, Accel::embree}) {
    const std::string name(kAccelNames[static_cast<size_t>(accel)]);
    const auto adjust = [accel](double, RenderSettings& settings) { settings.accel = accel; };
    out.push_back({.name = "scale-" + name,
                   .title = "A box with a lamp, scaled; intersector " + name,
                   .xLabel = "scale",
                   .values = {1e-6, 1e-4, 1e-2, 1e2, 1e4, 1e6},
                   .scene = [](double x) { return lampBox({.size = x}); },
                   .bound = 2e-3,
                   .boundSource = "the same seeds at scale 1; roundings differ, so some paths take other ways",
                   .methods = kEveryMethod,
                   .adjust = adjust});
    out.push_back({.name = "translation-" + name,
                   .title = "A box with a lamp, moved away from the origin; intersector " + name,
                   .xLabel = "distance in extents of the box",
                   .values = {1, 10, 1e3, 1e5},
                   .scene =
                       [](double x) {
                         return lampBox({.center = {2 * x, -1.4 * x, 0.6 * x}});
                       },
                   .bound = 2e-3,
                   .boundSource = "the same seeds at distance 1; roundings differ, so some paths take other ways",
                   .methods = kEveryMethod,
                   .adjust = adjust});
  }
  out.push_back({.name = "grazing",
                 .title = "A floor under the sky, seen at an angle",
                 .xLabel = "angle in radians",
                 .values = {1e-1, 1e-2, 1e-3, 1e-4, 1e-5},
                 .scene = grazedFloor,
                 .truth = [](double) { return 0.5; },
                 .bound = 1e-5,
                 .boundSource = "albedo times the sky's radiance, exactly; rounding of 24 bits",
                 .methods = {Method::pt, Method::bpt, Method::vcm, Method::mlt},
                 .leftOut = "lt, ppm, bpm: few light paths from all of the sky reach the strip that is seen",
                 .everyRun = true});
  out.push_back({.name = "slivers",
                 .title = "A floor under the sky, of triangles without and with little area, twice in one plane",
                 .xLabel = "aspect of triangles",
                 .values = {1, 1e2, 1e4, 1e6},
                 .scene = sliverFloor,
                 .truth = [](double) { return 0.5; },
                 .bound = 1e-5,
                 .boundSource = "albedo times the sky's radiance, exactly; rounding of 24 bits",
                 .methods = {Method::pt, Method::bpt, Method::vcm},
                 .leftOut = "lt, ppm, bpm, mlt: few light paths from all of the sky reach so small a floor",
                 // The narrowest floor ends 6e-6 beside the picture, and the radius is 5e-6 there. A merge that reached
                 // beyond the floor would be too dark.
                 .adjust = [](double, RenderSettings& settings) { settings.radius = 1e-5; },
                 .everyRun = true});
  // Near a corner, vertices on different walls are close to each other.
  out.push_back({.name = "corner",
                 .title = "The corner of a shining room, seen through a small field of view",
                 .xLabel = "field of view in degrees",
                 .values = {10, 1e-1, 1e-3, 1e-5},
                 .scene = [](double x) { return roomCorner(0.5, x); },
                 .truth = [](double) { return 2.0; },
                 .bound = 1e-3,
                 .boundSource = "1 / (1 - albedo); pairs of vertices closer than their offsets are not connected",
                 .methods = {Method::pt, Method::bpt, Method::mlt},
                 .leftOut = "lt, ppm, bpm, vcm: see corners of rooms by few light paths, or by a disc of photons",
                 .samples = samples(64)});
  out.push_back({.name = "close-view",
                 .title = "A wall of a shining room, seen from close by",
                 .xLabel = "distance of the camera in half sides",
                 .values = {1e-1, 1e-3, 1e-5},
                 .scene = [](double x) { return closeToWall(0.5, x); },
                 .truth = [](double) { return 2.0; },
                 .bound = 1e-3,
                 .boundSource = "1 / (1 - albedo)",
                 .methods = {Method::pt, Method::bpt, Method::mlt},
                 .leftOut = "lt, ppm, bpm, vcm: few light paths reach the part that is seen",
                 .samples = samples(64)});
}

// ---- surfaces -------------------------------------------------------------------------------------------------------

void addSurfaces(std::vector<Sweep>& out) {
  // At index 1 glass is air. Float can hardly tell 1 + 1e-7 from 1.
  out.push_back(
      {.name = "ior",
       .title = "A smooth glass sphere under the sky",
       .xLabel = "index of refraction",
       .values = {1, 1 + 1e-7, 1 + 1e-5, 1 + 1e-4, 1.01, 1.5, 20},
       .scene = [](double x) { return skySphere(glass(x)); },
       .truth = [](double) { return 1.0; },
       .bound = 1e-5,
       .boundSource = "radiance is kept: reflectance and transmittance add up to one",
       .methods = {Method::pt, Method::bpt, Method::ppm, Method::bpm, Method::vcm},
       .leftOut = "lt: makes no path from glass to the eye; mlt: at index 20 few of its paths leave the glass",
       .samples = samples(64),
       .everyRun = true});
  // Rough boundaries closer to index 1 than 1e-4 (kIndexMatched) are compiled as if they were that far away. Some
  // values are closer, others are not.
  out.push_back({.name = "ior-rough",
                 .title = "A rough glass sphere under the sky, close to index-matched",
                 .xLabel = "index of refraction",
                 .values = {1 - 1e-4, 1 - 1e-6, 1, 1 + 1e-6, 1.00009, 1.0002},
                 .scene = [](double x) { return skySphere(glass(x, 0.3)); },
                 .baseline = 1.0001,
                 .bound = 1e-3,
                 .boundSource = "the same seeds at 1.0001: directions change by the index' difference",
                 .methods = {Method::pt, Method::bpt, Method::mlt, Method::vcm},
                 .leftOut = "lt, ppm, bpm: light from all of the sky meets a small sphere too rarely",
                 .samples = samples(64)});
  // Below an alpha of 1e-3 (kSmallestAlpha) a surface is compiled as smooth. Some values are below, others above.
  for (const Distribution distribution : {Distribution::ggx, Distribution::beckmann}) {
    const std::string name = distribution == Distribution::ggx ? "ggx" : "beckmann";
    out.push_back({.name = "roughness-" + name,
                   .title = "A metal sphere that absorbs nothing under the sky; distribution " + name,
                   .xLabel = "alpha",
                   .values = {1e-2, 3e-3, 1.01e-3, 9.9e-4, 1e-5, 1e-6},
                   .scene = [distribution](double x) { return skySphere(conductor(x, distribution)); },
                   .truth = [](double) { return 1.0; },
                   .bound = 3e-3,
                   .boundSource = "a mirror's 1; facets shadow each other by about alpha at the sphere's rim",
                   .methods = {Method::pt, Method::bpt, Method::mlt, Method::vcm},
                   .leftOut = "lt, ppm, bpm: light from all of the sky meets a small sphere too rarely",
                   .samples = samples(64)});
  }
  // Along the normal the sines of all directions are 0.
  out.push_back({.name = "axes",
                 .title = "Squares seen along their normal: a mirror, thin glass, polished metal",
                 .xLabel = "1 mirror, 2 thin glass, 3 metal of alpha 0.002",
                 .values = {1, 2, 3},
                 .scene =
                     [](double x) {
                       if (x == 1) return skySquare(conductor(0, Distribution::ggx));
                       return skySquare(x == 2 ? glass(1.5, 0, true) : conductor(0.002, Distribution::ggx));
                     },
                 .truth = [](double) { return 1.0; },
                 .bound = 1e-4,
                 .boundSource = "radiance is kept; facets of alpha 0.002 lose alpha^2",
                 .methods = {Method::pt, Method::bpt, Method::mlt, Method::vcm},
                 .leftOut = "lt, ppm, bpm: make no path from a mirror to the eye, or merge at none"});
  out.push_back({.name = "within-glass",
                 .title = "The sky, seen from the centre of a glass sphere",
                 .xLabel = "index of refraction",
                 .values = {1.1, 1.5, 3},
                 .scene = [](double x) { return withinSphere(glass(x)); },
                 .truth = [](double x) { return x * x; },
                 .bound = 1e-4,
                 .boundSource = "radiance over squared index is kept",
                 .methods = {Method::pt, Method::bpt, Method::ppm, Method::bpm, Method::vcm},
                 .leftOut = "lt: makes no path from glass to the eye; mlt: its row is that of ior",
                 .samples = samples(64)});
  // A path straight through all spheres crosses two boundaries of each.
  out.push_back({.name = "nested",
                 .title = "Glass spheres within glass spheres under the sky",
                 .xLabel = "spheres",
                 .values = {1, 2, 4, 8},
                 .scene = [](double x) { return nestedGlass(static_cast<uint32_t>(x)); },
                 .truth = [](double) { return 1.0; },
                 .bound = 1e-4,
                 .boundSource = "radiance is kept",
                 .methods = {Method::pt, Method::bpt, Method::ppm, Method::bpm, Method::vcm},
                 .leftOut = "lt: makes no path from glass to the eye; mlt: its walks end at 64 edges",
                 .samples = samples(64)});
  // Paths grow to hundreds of vertices and the image is noisy, so a larger standard error is accepted.
  out.push_back({.name = "albedo",
                 .title = "A closed shining room",
                 .xLabel = "1 - albedo",
                 .values = {0.5, 0.1, 1e-2, 1e-3},
                 .scene = [](double x) { return shiningRoom(1 - x); },
                 .truth = [](double x) { return 1 / x; },
                 .bound = 1e-3,
                 .boundSource = "1 / (1 - albedo); no path is cut",
                 .methods = {Method::pt},
                 .leftOut = "others: join every two of hundreds of vertices; they cut after 4095 edges, mlt after 64",
                 .samples = samples(64),
                 .resolution = 0.08});
}

// ---- light ----------------------------------------------------------------------------------------------------------

void addLights(std::vector<Sweep>& out) {
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
                 .boundSource = "1 / (1 - albedo); a tenth of all picks goes to all lights alike",
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

// ---- films, samples and merging -------------------------------------------------------------------------------------

void addRenders(std::vector<Sweep>& out) {
  out.push_back({.name = "film",
                 .title = "A shining room on films of one pixel, one column and one row",
                 .xLabel = "1 one pixel, 2 one column of 4096, 3 one row of 4096",
                 .values = {1, 2, 3},
                 .scene =
                     [](double x) {
                       Scene scene = shiningRoom(0.5, 1);
                       scene.film.width = x == 3 ? 4096 : 1;
                       scene.film.height = x == 2 ? 4096 : 1;
                       // The field of view is that of one pixel, and the column is 4096 pixels high.
                       if (x == 2) scene.sensor.fovX = 0.01;
                       return scene;
                     },
                 .truth = [](double) { return 2.0; },
                 .bound = 1e-3,
                 .boundSource = "1 / (1 - albedo)",
                 .methods = {Method::pt, Method::bpt},
                 .leftOut = "others: few light paths reach what so narrow a film sees",
                 .samples = [](double x) { return x == 1 ? uint64_t{1} << 14 : uint64_t{16}; }});
  // At albedo 0 every sample is 1, so the sum over samples is all that can go wrong.
  out.push_back({.name = "samples",
                 .title = "Samples of one pixel that are all alike",
                 .xLabel = "samples",
                 .values = {1, 1e3, 1e6},
                 .scene =
                     [](double) {
                       Scene scene = shiningRoom(0);
                       scene.film.width = scene.film.height = 1;
                       return scene;
                     },
                 .truth = [](double) { return 1.0; },
                 .bound = 1e-7,
                 .boundSource = "sums in double lose nothing that the image's float shows",
                 .methods = {Method::pt},
                 .leftOut = "others: sum into the same film",
                 .samples = [](double x) { return static_cast<uint64_t>(x); }});
  // At alpha 0 the radius shrinks fastest, at 1 not at all. The smallest values are below kSmallestRadius, which the
  // renderer uses instead of a smaller radius.
  for (const double alpha : {0.0, 0.75, 1.0}) {
    out.push_back({.name = fmt::format("merge-radius-alpha-{:g}", alpha),
                   .title = fmt::format("A box with a lamp by merging, the radius shrinking by alpha {:g}", alpha),
                   .xLabel = "first radius in radii of the scene",
                   .values = {1e-9, 1e-7, 1e-5, 1e-3, 1e-2},
                   .scene = [](double) { return lampBox({}); },
                   .against = Method::pt,
                   .bound = 1e-2,
                   .boundSource = "path tracing in double; discs reach over edges by radius / side",
                   .methods = {Method::vcm},
                   .leftOut = "ppm, bpm: nothing is found within the smallest radii; larger ones are in the next",
                   .adjust =
                       [alpha](double x, RenderSettings& settings) {
                         settings.radius = x;
                         settings.radiusAlpha = alpha;
                       },
                   .samples = samples(64)});
  }
  out.push_back({.name = "merge-radius-alone",
                 .title = "A box with a lamp by merging alone",
                 .xLabel = "first radius in radii of the scene",
                 .values = {1e-2, 2e-2, 4e-2},
                 .scene = [](double) { return lampBox({}); },
                 .against = Method::pt,
                 .bound = 6e-2,
                 .boundSource = "path tracing in double; discs reach over edges by radius / side, at all walls",
                 .methods = {Method::ppm, Method::bpm},
                 .leftOut = "others: do not merge, or not alone",
                 .adjust =
                     [](double x, RenderSettings& settings) {
                       settings.radius = x;
                       // The reference by path tracing gets the same call, and has no light paths.
                       if (settings.method != Method::pt) settings.lightPaths = 4096;
                     },
                 .samples = samples(32)});
}

}  // namespace

std::vector<Sweep> allSweeps() {
  std::vector<Sweep> out;
  addGeometry(out);
  addSurfaces(out);
  addLights(out);
  addRenders(out);
  return out;
}

}  // namespace wavecrest
