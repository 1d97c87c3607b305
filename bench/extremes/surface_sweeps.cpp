// Sweeps over what surfaces are made of.
#include "bench/extremes/extreme_scenes.h"
#include "bench/extremes/sweep_parts.h"

namespace wavecrest {
namespace {

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

// Indices of refraction and roughness.
void addBoundaries(std::vector<Sweep>& out) {
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
}

// Directions, nested spheres and rooms, whose paths meet many surfaces.
void addPaths(std::vector<Sweep>& out) {
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

}  // namespace

void addSurfaceSweeps(std::vector<Sweep>& out) {
  addBoundaries(out);
  addPaths(out);
}

}  // namespace wavecrest
