#include "engine/pilot/merge_radius.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "engine/pilot/light_walks.h"
#include "engine/pilot/median.h"
#include "engine/pilot/repeated_pixels.h"
#include "engine/pilot/view_walk.h"

namespace wavecrest {
namespace {

using Position = std::array<float, 3>;

constexpr uint64_t kPilotSeed = ~uint64_t{0};

// Pixels in the middles of equal rectangles of the film.
std::vector<uint32_t> spreadPixels(const CameraView& camera) {
  constexpr uint32_t kAcross = 32, kDown = 32;
  std::vector<uint32_t> pixels;
  for (uint32_t y = 0; y < kDown; ++y) {
    for (uint32_t x = 0; x < kAcross; ++x) {
      const auto middle = [](uint32_t i, uint32_t count, uint32_t size) { return (2 * i + 1) * size / (2 * count); };
      pixels.push_back(middle(y, kDown, camera.height) << 16 | middle(x, kAcross, camera.width));
    }
  }
  return pixels;
}

// What the pilot keeps of each path, by lanes of the wave.
struct CameraPath {
  double place[3]{};   // of the latest vertex
  double length = 0;   // so far
  double density = 0;  // p_cam of METHODS 4.1, or of parallel rays per area
  // Once it has merged: of MergePlace, and the normal there.
  std::optional<size_t> merged;
  double normal[3]{};
  bool left = false;
};

template <class S>
void beginPaths(Wave<S>& wave, const CameraView& camera, std::vector<CameraPath>& paths) {
  for (size_t i = 0; i < wave.rays.size; ++i) {
    CameraPath& path = paths[wave.paths.lane[i]];
    const double along = wave.rays.directionX[i] * camera.axis[0] + wave.rays.directionY[i] * camera.axis[1] +
                         wave.rays.directionZ[i] * camera.axis[2];
    // Distances are from the lens, and rays begin at the near clip.
    path.length = camera.parallel ? 0 : camera.nearClip / along;
    path.density = camera.parallel ? std::sqrt(camera.inverseDu2 * camera.inverseDv2)
                                   : camera.pixelDistance * camera.pixelDistance / (along * along * along);
    path.place[0] = wave.rays.originX[i];
    path.place[1] = wave.rays.originY[i];
    path.place[2] = wave.rays.originZ[i];
  }
}

// Of a ray to or from the place where a path has merged, to its normal.
template <class S>
double cosineOfRay(const Wave<S>& wave, size_t ray, const CameraPath& path) {
  const double cosine = wave.rays.directionX[ray] * path.normal[0] + wave.rays.directionY[ray] * path.normal[1] +
                        wave.rays.directionZ[ray] * path.normal[2];
  return std::abs(cosine);
}

// Goes on to the vertices of a depth. Adds a place for each path that can merge for the first time. Whether any path
// had not merged before.
template <class S>
bool visitVertices(Wave<S>& wave, bool parallel, std::vector<CameraPath>& paths, std::vector<MergePlace>& places) {
  constexpr double kLeastCosine = 1e-3;
  bool any = false;
  for (size_t i = 0; i < wave.rays.size; ++i) {
    CameraPath& path = paths[wave.paths.lane[i]];
    if (path.merged) continue;
    any = true;
    const double vertex[3] = {static_cast<double>(wave.rays.originX[i]), static_cast<double>(wave.rays.originY[i]),
                              static_cast<double>(wave.rays.originZ[i])};
    path.length += std::hypot(vertex[0] - path.place[0], vertex[1] - path.place[1], vertex[2] - path.place[2]);
    std::copy_n(vertex, 3, path.place);
    if (i >= wave.joinable) continue;
    path.merged = places.size();
    path.normal[0] = wave.surfaces.normalX[i];
    path.normal[1] = wave.surfaces.normalY[i];
    path.normal[2] = wave.surfaces.normalZ[i];
    // As if mirrors and glass on the way were flat.
    const double across = (parallel ? 1 : path.length * path.length) / path.density;
    MergePlace place{.pixel = std::sqrt(across / std::max(cosineOfRay(wave, i, path), kLeastCosine))};
    for (size_t axis = 0; axis < 3; ++axis) place.position[axis] = static_cast<float>(vertex[axis]);
    places.push_back(place);
  }
  return any;
}

// Sets the `lobes` of places. Photons come from all sides, and count by f: with directions sampled by f, the mean of
// f^2 over the square of the mean of f is the mean of pi p / cos. The cosine has a bound, as grazing directions, in
// which few photons come, would have most of the mean.
template <class S>
ViewLeft<S> lobesOf(std::vector<CameraPath>& paths, std::vector<MergePlace>& places) {
  return [&](const Wave<S>& wave) {
    constexpr double kLeastCosine = 0.05;
    for (size_t i = 0; i < wave.rays.size; ++i) {
      CameraPath& path = paths[wave.paths.lane[i]];
      if (!path.merged || std::exchange(path.left, true)) continue;
      const auto inversePdf = static_cast<double>(wave.paths.dVCM[i]);
      if (!(inversePdf > 0)) continue;
      const double cosine = std::max(cosineOfRay(wave, i, path), kLeastCosine);
      places[*path.merged].lobes = std::max(std::numbers::pi / (inversePdf * cosine), 1.0);
    }
  };
}

// For each depth of the camera walks: updates `paths`, and appends to `places` where a path can merge first.
template <class S>
ViewLook<S> placesOf(const CameraView& camera, std::vector<CameraPath>& paths, std::vector<MergePlace>& places) {
  return [&](Wave<S>& wave, uint32_t depth) {
    if (depth != 0) return visitVertices(wave, camera.parallel, paths, places);
    beginPaths(wave, camera, paths);
    return true;
  };
}

// METHODS 6.5, relative to the scene's radius. filmPixels: of the whole film; lightPaths: of an iteration;
// ofPath: photons of a light path.
double radiusOfImage(const MergeRadius& found, double filmPixels, double lightPaths, const PhotonDensity& ofPath,
                     const RenderSettings& settings) {
  if (!(found.pixel > 0)) return kFixedRadius;
  constexpr double kFirstVertex = 2.1, kAllVertices = 1.7;  // pixels, where a disc of one pixel's radius has one photon
  // Photons in a search: of vcm, and at least of ppm; at least of bpm.
  constexpr double kPhotons = 5, kLeastAllVertices = 3.5;
  constexpr double kLeastPixels = 0.5, kMostPixels = 8;
  const double pixel = found.pixel * std::sqrt(filmPixels / kUsualFilm);
  const bool connects = choosesMergeVertices(settings.method);
  const bool atFirst =
      connects ? settings.mergeVertices == MergeVertices::first : strategiesOf(settings.method).mergeAtFirstVertex;
  const double photons = std::numbers::pi * pixel * pixel * ofPath.perArea * kUsualFilm;
  const double smooth = std::cbrt(1 / photons);
  const auto ofPhotons = [photons](double count) { return std::sqrt(count / photons); };
  double pixels = kAllVertices * smooth;
  if (atFirst) pixels = connects ? ofPhotons(kPhotons) : std::max(kFirstVertex * smooth, ofPhotons(kPhotons));
  if (!atFirst && !connects) pixels = std::max(pixels, ofPhotons(kLeastAllVertices));
  // The radius depends on the total number of light paths so far, not on how many an iteration has. Where all vertices
  // merge, photon searches dominate the cost, so the radius shrinks faster with the light paths of an iteration.
  const double shrunk = std::pow(lightPaths / kUsualFilm, (settings.radiusAlpha - 1) / 2 - (atFirst ? 0 : 0.25));
  // Only ppm takes the light of narrow lobes from photons: the others sample or connect them. The sixth root: with so
  // many times the noise at a radius, and bias as it is, that much more is best.
  const double lobes = atFirst && !connects ? std::pow(ofPath.lobes, 1.0 / 6) : 1;
  const double wanted =
      std::max(std::min(pixels, kMostPixels) * pixel * shrunk * lobes, kLeastPixels * found.pixel) / found.scene;
  // Three digits, so that the last bits, in which instruction sets and precisions differ, do not change the choice.
  const double unit = std::pow(10, std::floor(std::log10(wanted)) - 2);
  const double chosen = std::round(wanted / unit) * unit;
  // Weights that take photons which share a camera path for independent ones make vcm pay for larger radii.
  return connects && !atFirst ? std::min(chosen, kFixedRadius) : chosen;
}

}  // namespace

template <class S>
std::vector<MergePlace> findMergePlaces(const RenderPlan<S>& plan, const RenderSettings& settings) {
  const CameraView& camera = plan.view.camera;
  const std::vector<uint32_t> all = spreadPixels(camera);
  std::vector<MergePlace> places;
  uint64_t seed = kPilotSeed;
  for (const std::vector<size_t>& visit : visitsOf(all)) {
    std::vector<uint32_t> pixels;
    pixels.reserve(visit.size());
    for (const size_t i : visit) pixels.push_back(all[i]);
    std::vector<CameraPath> paths(pixels.size());
    walkViews<S>(plan, settings, pixels, seed--, nullptr, placesOf<S>(camera, paths, places),
                 lobesOf<S>(paths, places));
  }
  return places;
}
template std::vector<MergePlace> findMergePlaces(const RenderPlan<float>&, const RenderSettings&);
template std::vector<MergePlace> findMergePlaces(const RenderPlan<double>&, const RenderSettings&);

PhotonDensity photonDensity(std::span<const MergePlace> places, std::span<const Position> positions,
                            double photonsPerPosition) {
  // The disc to the kNearest-th position has kNearest - 1 in it and one at its rim.
  constexpr size_t kNearest = 8, kMostPlaces = 256;
  // By x, so that a place is compared with its neighbours alone.
  const auto toX = [](const Position& position) { return position[0]; };
  std::vector<Position> sorted(positions.begin(), positions.end());
  std::erase_if(sorted, [](const Position& position) { return !std::isfinite(position[0]); });
  if (sorted.size() < kNearest || places.empty()) return {};
  std::ranges::sort(sorted, {}, toX);
  double areas = 0, lobeAreas = 0;
  size_t count = 0;
  const size_t step = std::max<size_t>(places.size() / kMostPlaces, 1);
  for (size_t i = 0; i < places.size(); i += step) {
    const Position& here = places[i].position;
    // The least squared distances so far, in order.
    std::array<float, kNearest> nearest;
    nearest.fill(std::numeric_limits<float>::infinity());
    // Whether positions that are farther in x can be nearer: the sum of squares, as it is rounded, is no less than that
    // of x alone.
    const auto visit = [&](const Position& there) {
      const float x = there[0] - here[0], y = there[1] - here[1], z = there[2] - here[2];
      if (!(x * x < nearest.back())) return false;
      const float square = x * x + y * y + z * z;
      if (!(square < nearest.back())) return true;
      size_t k = kNearest - 1;
      for (; k > 0 && square < nearest[k - 1]; --k) nearest[k] = nearest[k - 1];
      nearest[k] = square;
      return true;
    };
    const auto middle = std::ranges::lower_bound(sorted, here[0], {}, toX);
    for (auto next = middle; next != sorted.end() && visit(*next); ++next) {
    }
    for (auto next = middle; next != sorted.begin() && visit(*std::prev(next)); --next) {
    }
    const double area = std::numbers::pi * nearest.back();
    areas += area;
    lobeAreas += area * places[i].lobes;
    ++count;
  }
  // Of even positions the disc of the k-th has k / density in the mean.
  if (!(areas > 0)) return {};
  return {.perArea = kNearest * photonsPerPosition * static_cast<double>(count) / areas, .lobes = lobeAreas / areas};
}

template <class S>
MergeRadius chosenRadius(const RenderPlan<S>& plan, const RenderSettings& settings, const FilmArea& area) {
  // Both walks have numbers of their own, so that renders of all seeds have one radius.
  RenderSettings pilot = settings;
  pilot.sampler = SamplerKind::independent;
  pilot.seed = kPilotSeed;
  pilot.lightPaths = kPilotLightPaths;
  const LightPilot light = walkLightPaths(plan, pilot, area);
  const std::vector<MergePlace> places = findMergePlaces(plan, settings);
  std::vector<double> pixels;
  pixels.reserve(places.size());
  for (const MergePlace& place : places) pixels.push_back(place.pixel);
  MergeRadius radius = plan.mergeRadius;
  radius.pixel = medianOf(std::move(pixels));
  const PhotonDensity ofPath =
      photonDensity(places, light.photons, 1 / static_cast<double>(std::max<size_t>(light.paths, 1)));
  radius.photonsPerArea = ofPath.perArea * static_cast<double>(plan.memory.lightPaths);
  if (settings.radius) return radius;
  const CameraView& camera = plan.view.camera;
  const size_t filmPixels = size_t{camera.width} * camera.height;
  radius.first = radiusOfImage(radius, static_cast<double>(filmPixels),
                               static_cast<double>(lightPathsWanted(settings, filmPixels)), ofPath, settings);
  return radius;
}
template MergeRadius chosenRadius(const RenderPlan<float>&, const RenderSettings&, const FilmArea&);
template MergeRadius chosenRadius(const RenderPlan<double>&, const RenderSettings&, const FilmArea&);

}  // namespace wavecrest
