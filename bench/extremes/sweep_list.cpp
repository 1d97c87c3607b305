// The list of sweeps, and those over geometry, films, samples and merging. Each names what it varies, what the answer
// is, and where its bound comes from.
#include <fmt/core.h>

#include "bench/extremes/extreme_scenes.h"
#include "bench/extremes/sweep_parts.h"

namespace wavecrest {
namespace {

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
  addSurfaceSweeps(out);
  addLightSweeps(out);
  addRenders(out);
  return out;
}

}  // namespace wavecrest
