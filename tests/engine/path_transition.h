// Contribution and transition densities of paths from scratch, in scalar double code: what the ratios by which
// mutations are accepted are compared with.
//
// in: vertices of two paths and what a mutation has replaced. out: f(x) and T(x -> y) (METHODS 7.6), each the whole
// product of densities per area, nothing cancelled, and every choice counted out. For diffuse surfaces, smooth mirrors
// and smooth dielectrics under a quad light.
#pragma once

#include <vector>

#include "kernels/columns/chain_paths.h"
#include "kernels/mutate/path_law.h"
#include "tests/engine/reference_bsdf.h"

namespace wavecrest {

struct ScratchVertex {
  Double3 position{}, normal{};
  uint32_t primitive = 0;  // of x_0 the light
  bool specular = false;
};
using ScratchPath = std::vector<ScratchVertex>;  // x_0 .. x_k

template <class S>
ScratchPath scratchPath(const PathStore<S>& store, size_t lane) {
  ScratchPath path;
  const auto& v = store.vertices;
  for (uint32_t row = 0; row <= store.headers.edges[lane]; ++row) {
    const size_t at = row * store.stride() + lane;
    path.push_back({{v.positionX[at], v.positionY[at], v.positionZ[at]},
                    {v.normalX[at], v.normalY[at], v.normalZ[at]},
                    v.primitive[at],
                    v.event[at] != 0});
  }
  return path;
}

// What a mutation does to a path of `from` edges: PathPlans.
struct Replacement {
  Mutation kind;
  uint32_t kept, fromEnd, end;
  Replacement reversed() const { return {kind, kept, end, fromEnd}; }
};

struct TransitionSettings {
  uint32_t minEdges, maxEdges;
  double largeStep;
};

template <class S>
class PathTransition {
 public:
  PathTransition(const SceneView<S>& scene, double pixels, const TransitionSettings& settings)
      : scene_(scene), pixels_(pixels), settings_(settings) {}

  // Luminance of the contribution per area of every vertex; a delta lobe in the measure of ReferenceBsdf.
  double contribution(const ScratchPath& x) const {
    const size_t k = x.size() - 1;
    const auto& light = scene_.lights[x[0].primitive];
    double value[3];
    for (size_t c = 0; c < 3; ++c) value[c] = light.radiance[c];
    for (size_t i = 1; i < k; ++i) {
      for (size_t c = 0; c < 3; ++c) value[c] *= bsdf(x, i, c) * cosine(x, i, i - 1);
      // A light shines from its front alone.
      const double there = i == 1 ? std::max(dot(direction(x, 0, 1), x[0].normal), 0.0) : cosine(x, i - 1, i);
      const double toArea = there / distance2(x, i, i - 1);
      for (double& v : value) v *= toArea;
    }
    const double lens = lensDensity(x);
    return lens * (0.2126 * value[0] + 0.7152 * value[1] + 0.0722 * value[2]);
  }

  // Density with which a mutation turns x into y, per area of the rows that it makes.
  double transition(const ScratchPath& x, const ScratchPath& y, const Replacement& r) const {
    switch (r.kind) {
      case Mutation::large:
        return settings_.largeStep * lengthShare(y.size() - 1) * splitSum(y, 0, static_cast<uint32_t>(y.size()));
      case Mutation::bidirectional:
        return kindShare(x) * replacementShare(x.size() - 1, y.size() - 1, r) * splitSum(y, r.kept, r.end);
      case Mutation::lens:
      case Mutation::multiChain:
        return kindShare(x) * eyePerturbation(x, y, r.kept);
      case Mutation::caustic:
        return kindShare(x) * causticPerturbation(x, y, r.kept);
      default:
        ADD_FAILURE() << "no mutation of paths";
        return 0;
    }
  }

 private:
  static Double3 direction(const ScratchPath& x, size_t from, size_t to) {
    return normalized(x[to].position - x[from].position);
  }
  static double distance2(const ScratchPath& x, size_t a, size_t b) {
    const Double3 edge = x[a].position - x[b].position;
    return dot(edge, edge);
  }
  static double cosine(const ScratchPath& x, size_t at, size_t to) {
    return std::abs(dot(direction(x, at, to), x[at].normal));
  }

  const MaterialRecord& material(const ScratchVertex& v) const {
    return scene_.materials[scene_.primitives[v.primitive].material];
  }
  // Per solid angle of the direction from x_i to x_next, arriving from x_from.
  double density(const ScratchPath& x, size_t i, size_t from, size_t next) const {
    const Double3 wi = direction(x, i, from), wo = direction(x, i, next);
    const auto reference = ReferenceBsdf::facing(material(x[i]), x[i].normal, wi);
    return x[i].specular ? reference.specularDensity(wi, wo) : reference.pdfW(wi, wo);
  }
  // The probability of the lobe that x_i takes, where it is a delta.
  double lobe(const ScratchPath& x, size_t i, size_t from, size_t next) const {
    const Double3 wo = direction(x, i, next);
    const bool inside = dot(wo, x[i].normal) < 0;
    const MaterialRecord& m = material(x[i]);
    const bool glass = static_cast<BsdfKind>(m.kind) == BsdfKind::dielectric;
    const double eta2 = glass && inside ? double{m.eta[0]} * m.eta[0] : 1.0;
    return density(x, i, from, next) / (eta2 * std::abs(dot(wo, x[i].normal)));
  }

  double bsdf(const ScratchPath& x, size_t i, size_t channel) const {
    const MaterialRecord& m = material(x[i]);
    const Double3 toEye = direction(x, i, i + 1), toLight = direction(x, i, i - 1);
    if (!x[i].specular) {
      const auto reference = ReferenceBsdf::facing(m, x[i].normal, toEye);
      return reference.pdfW(toEye, toLight) > 0 ? double{m.reflectance[channel]} / std::numbers::pi : 0;
    }
    // An eye walk's f c / pdf is the lobe's tint, and of refraction (eta_wi / eta_wo)^2 times that.
    double weight = m.specular[channel];
    if (dot(toEye, x[i].normal) * dot(toLight, x[i].normal) < 0) {
      const double eta = dot(toEye, x[i].normal) > 0 ? 1 / double{m.eta[0]} : double{m.eta[0]};
      weight = double{m.transmittance[channel]} * eta * eta;
    }
    return weight * density(x, i, i + 1, i - 1) / std::abs(dot(toLight, x[i].normal));
  }

  double cameraPdfW(const ScratchPath& x) const {
    const CameraView& camera = scene_.camera;
    const double cos = dot(direction(x, x.size() - 1, x.size() - 2), {camera.axis[0], camera.axis[1], camera.axis[2]});
    return camera.pixelDistance * camera.pixelDistance / (cos * cos * cos);
  }
  // Of x_{k-1}, from the lens over the whole film.
  double lensDensity(const ScratchPath& x) const {
    const size_t k = x.size() - 1;
    return cameraPdfW(x) / pixels_ * cosine(x, k - 1, k) / distance2(x, k, k - 1);
  }

  // Of x_i, from the eye's side and from the light's.
  double fromEye(const ScratchPath& x, size_t i) const {
    if (i + 2 == x.size()) return lensDensity(x);
    return density(x, i + 1, i + 2, i) * cosine(x, i, i + 1) / distance2(x, i, i + 1);
  }
  double fromLight(const ScratchPath& x, size_t i) const {
    const auto& light = scene_.lights[x[0].primitive];
    if (i == 0) return double{light.pick} * double{light.inverseArea};
    const double toArea = cosine(x, i, i - 1) / distance2(x, i, i - 1);
    if (i == 1) return std::max(dot(direction(x, 0, 1), x[0].normal), 0.0) / std::numbers::pi * toArea;
    return density(x, i - 1, i - 2, i) * toArea;
  }

  // Mean over the splits of rows [kept, end) into a light walk and an eye walk.
  double splitSum(const ScratchPath& y, uint32_t kept, uint32_t end) const {
    const size_t k = y.size() - 1, rows = end - kept;
    size_t splits = rows + 1;
    if (end == k + 1) splits = rows;  // the lens is on the eye's side
    if (k == 1) splits = 1;
    double sum = 0;
    for (size_t s = 0; s < splits; ++s) {
      const size_t first = kept + s;  // of the eye's side
      const bool chance = first == 0;
      const auto joins = [&](size_t row) { return row == 0 || row == k || !y[row].specular; };
      if (!chance && (!joins(first - 1) || !joins(first))) continue;
      double p = 1;
      for (size_t row = kept; row < first; ++row) p *= fromLight(y, row);
      for (size_t row = first; row < std::min<size_t>(end, k); ++row) p *= fromEye(y, row);
      sum += p;
    }
    return sum / static_cast<double>(splits);
  }

  // ---- choices
  // --------------------------------------------------------------------------------------------------------

  double lengthShare(size_t edges) const {
    double sum = 0;
    for (uint32_t k = settings_.minEdges; k <= settings_.maxEdges; ++k) sum += std::pow(0.85, k);
    return std::pow(0.85, static_cast<double>(edges)) / sum;
  }

  // One of the mutations that suit x: from the eye, bidirectional, caustic.
  double kindShare(const ScratchPath& x) const {
    const size_t k = x.size() - 1;
    const int kinds = 1 + (k >= 2 ? 1 : 0) + (k >= 2 && !x[k - 1].specular ? 1 : 0);  // the light is no infinite one
    return (1 - settings_.largeStep) / kinds;
  }

  // Deleting the rows between the kept ones from a path of k edges, and adding those of a path of `edges` in their
  // place.
  double replacementShare(size_t k, size_t edges, const Replacement& r) const {
    const auto weight = [](size_t deleted) {
      return deleted == 1 ? 0.25 : deleted == 2 ? 0.5 : std::exp2(-static_cast<double>(deleted));
    };
    const size_t mine = r.fromEnd + 1 - r.kept;
    double sum = 0, like = 0;
    for (size_t deleted = 1; deleted <= k + 2; ++deleted) {
      double count = 0;
      for (size_t kept = 0; kept + deleted <= k + 2; ++kept) {
        const size_t end = kept + deleted - 1;
        const bool allowed = kept != 1 && end >= 1 && end != k && kept <= k && !(kept == 0 && end == k + 1);
        count += allowed ? 1 : 0;
      }
      if (count > 0) sum += weight(deleted);
      if (deleted == mine) like = count;
    }
    const double deletion = weight(mine) / sum / like;

    const auto added = [&](int more) {
      constexpr double kShares[] = {0.5, 0.15, 0.05, 0.025, 0.0125, 0.00625, 0.003125};
      return kShares[std::abs(more)];
    };
    const int deletedRows = static_cast<int>(r.fromEnd - r.kept);
    int least = (r.kept == 0 ? 1 : 0) + (r.fromEnd == k + 1 ? 1 : 0);
    if (deletedRows == 0) least = std::max(least, 1);
    double possible = 0;
    for (int more = -6; more <= 6; ++more) {
      const int length = static_cast<int>(k) + more;
      const bool allowed = deletedRows + more >= least && length >= static_cast<int>(settings_.minEdges) &&
                           length <= static_cast<int>(settings_.maxEdges);
      possible += allowed ? added(more) : 0;
    }
    return deletion * added(static_cast<int>(edges) - static_cast<int>(k)) / possible;
  }

  // ---- perturbations
  // --------------------------------------------------------------------------------------------------

  static double angleBetween(const Double3& a, const Double3& b) {
    const Double3 c = cross(a, b);
    return std::atan2(std::sqrt(dot(c, c)), dot(a, b));
  }
  // Per solid angle, of a turn by theta; up to the constant for the given range.
  static double turnDensity(double theta, double logRatio) {
    return 1 / (2 * std::numbers::pi * theta * std::sin(theta) * logRatio);
  }

  double eyePerturbation(const ScratchPath& x, const ScratchPath& y, uint32_t end) const {
    const size_t k = y.size() - 1;
    // In the image plane: the density of offsets is the same there and back, as are those of angles.
    const Double3 before = direction(x, k, k - 1), after = direction(y, k, k - 1);
    const CameraView& camera = scene_.camera;
    const Double3 axis{camera.axis[0], camera.axis[1], camera.axis[2]};
    const Double3 offset = (after * (1 / dot(after, axis)) - before * (1 / dot(before, axis))) * camera.pixelDistance;
    double density2 = cameraPdfW(y) * cosine(y, k - 1, k) / distance2(y, k, k - 1) / dot(offset, offset);
    for (size_t row = k - 1; row > end; --row) {
      const double toArea = cosine(y, row - 1, row) / distance2(y, row, row - 1);
      if (y[row].specular) {
        density2 *= density(y, row, row + 1, row - 1) / lobe(y, row, row + 1, row - 1) * toArea;
      } else {
        density2 *= turnDensity(angleBetween(direction(x, row, row - 1), direction(y, row, row - 1)), 1) * toArea;
      }
    }
    return density2;
  }

  double causticPerturbation(const ScratchPath& x, const ScratchPath& y, uint32_t start) const {
    const size_t k = y.size() - 1;
    double length = 0;
    for (size_t row = start - 1; row + 1 < k; ++row) length += std::sqrt(distance2(x, row, row + 1));
    const double scale = std::sqrt(distance2(x, k - 1, k)) / length / scene_.camera.pixelDistance;
    const double largest = std::min(std::sqrt(0.05 * pixels_ / std::numbers::pi) * scale, 1.5);
    const double smallest = std::min(0.1 * scale, largest / 2);
    const double theta = angleBetween(direction(x, start - 1, start), direction(y, start - 1, start));
    if (theta < smallest * 0.999 || theta > largest * 1.001) return 0;
    double density2 = turnDensity(theta, std::log(largest / smallest));
    for (size_t row = start; row < k; ++row) {
      density2 *= cosine(y, row, row - 1) / distance2(y, row, row - 1);
      if (row + 1 < k) density2 *= density(y, row, row - 1, row + 1) / lobe(y, row, row - 1, row + 1);
    }
    return density2;
  }

  const SceneView<S>& scene_;
  const double pixels_;
  const TransitionSettings settings_;
};

}  // namespace wavecrest
