// The MIS recursion on random synthetic paths (METHODS 5, 10.3): no scene, so every corner of it is met. Densities,
// cosines, lengths, kinds of events and of lights are random; the weights of all strategies follow once from the
// recursion's partial sums and once from the plain products of densities that the sums stand for.
//
// One lane is one path. Initialisation, arrival and the final weights are written here as METHODS 5.3, 5.4 and 5.6 say;
// scattering and what lies behind a vertex come from kernels/mis_lanes.h on each instruction set.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "tests/kernels/isa_test.h"
#include "tests/kernels/mis_entries.h"

namespace wavecrest {
namespace {

constexpr size_t kMisPaths = 512;

// One value per path, padded for the widest lanes.
template <class S>
struct Values : std::vector<S> {
  Values() : std::vector<S>(kMisPaths + 16, S(1)) {}
};

// x_i of every path. Towards the light and towards the camera: density of sampling that direction given the other, per
// solid angle or for a delta lobe as a probability, cosines to the geometric and to the shading normal, index.
template <class S>
struct SyntheticVertex {
  Values<S> pdfToLight, pdfToCamera;
  Values<S> normalToLight, normalToCamera, shadingToLight, shadingToCamera, etaToLight, etaToCamera;
  Values<S> dist2;  // to x_{i+1}
  std::vector<char> specular = std::vector<char>(kMisPaths, 0);
};

template <class S>
struct SyntheticPaths {
  std::vector<SyntheticVertex<S>> x;              // x_0 .. x_k
  Values<S> direct, position, direction, camera;  // densities of the ends, per area or solid angle as they are sampled
  std::vector<char> delta = std::vector<char>(kMisPaths, 0), infinite = std::vector<char>(kMisPaths, 0);

  SyntheticPaths(size_t k, std::mt19937_64& random) : x(k + 1) {
    const auto between = [&](double low, double high) {  // uniform in the logarithm
      return static_cast<S>(low * std::pow(high / low, std::uniform_real_distribution<double>()(random)));
    };
    for (size_t path = 0; path < kMisPaths; ++path) {
      for (size_t i = 0; i <= k; ++i) {
        SyntheticVertex<S>& v = x[i];
        v.specular[path] = i >= 1 && i < k && random() % 3 == 0;
        const double most = v.specular[path] != 0 ? 1 : 30;
        v.pdfToLight[path] = between(0.03, most);
        v.pdfToCamera[path] = between(0.03, most);
        v.normalToLight[path] = between(0.05, 1);
        v.normalToCamera[path] = between(0.05, 1);
        v.shadingToLight[path] = between(0.05, 1);
        v.shadingToCamera[path] = between(0.05, 1);
        v.etaToLight[path] = random() % 2 == 0 ? S(1) : S(1.5);
        v.etaToCamera[path] = random() % 2 == 0 ? S(1) : S(1.5);
        v.dist2[path] = between(0.05, 20);
      }
      direct[path] = between(0.05, 20);
      position[path] = between(0.05, 20);
      direction[path] = between(0.05, 20);
      camera[path] = between(1, 1000);
      delta[path] = random() % 3 == 0;
      infinite[path] = random() % 3 == 0;
    }
  }
  size_t k() const { return x.size() - 1; }
};

// ---- from the recursion ---------------------------------------------------------------------------------------------

template <class S>
struct Sums {
  Values<S> dVCM, dVC;
  MisColumns<S> columns() { return {dVCM.data(), dVC.data()}; }
  void divide(size_t path, S area, S cosine) {
    dVCM[path] *= area / cosine;
    dVC[path] /= cosine;
  }
};

// Scatters every path at x_i, walking away from the light or from the camera.
template <class S>
void scatter(const MisKernels<S>& kernels, const MisSettings& mis, uint32_t depth, const SyntheticVertex<S>& v,
             Walk walk, Sums<S>& sums) {
  const bool light = walk == Walk::light;
  const Values<S>&forward = light ? v.pdfToCamera : v.pdfToLight, &reverse = light ? v.pdfToLight : v.pdfToCamera;
  const Values<S>& woNormal = light ? v.normalToCamera : v.normalToLight;
  Sums<S> over = sums;
  Values<S> jacobian;
  for (size_t path = 0; path < kMisPaths; ++path) {
    const S wiShading = light ? v.shadingToLight[path] : v.shadingToCamera[path],
            woShading = light ? v.shadingToCamera[path] : v.shadingToLight[path],
            wiEta = light ? v.etaToLight[path] : v.etaToCamera[path],
            woEta = light ? v.etaToCamera[path] : v.etaToLight[path];
    const S eta = wiEta / woEta;
    jacobian[path] = reverse[path] / forward[path] * woNormal[path] * wiShading / woShading * eta * eta;
  }
  kernels.scatterSpecular(kMisPaths, jacobian.data(), over.columns());
  kernels.scatter(mis, walk, depth, kMisPaths, forward.data(), reverse.data(), woNormal.data(), sums.columns());
  for (size_t path = 0; path < kMisPaths; ++path) {
    if (v.specular[path] == 0) continue;
    sums.dVCM[path] = over.dVCM[path];
    sums.dVC[path] = over.dVC[path];
  }
}

// The sums of the light sub-path after arrival at x_1, x_2, ... x_{k-1}; entry 0 is unused.
template <class S>
std::vector<Sums<S>> walkLight(const MisKernels<S>& kernels, const MisSettings& mis, const SyntheticPaths<S>& p) {
  std::vector<Sums<S>> out(p.k());
  Sums<S> sums;
  for (size_t path = 0; path < kMisPaths; ++path) {
    const S emission = p.position[path] * p.direction[path];
    const S n0 = p.infinite[path] != 0 ? S(1) : p.x[0].normalToCamera[path];
    sums.dVCM[path] = mis.nextEvent ? p.direct[path] / emission : S(0);
    sums.dVC[path] = p.delta[path] != 0 || !mis.emission ? S(0) : n0 / emission;
  }
  for (size_t i = 1; i < p.k(); ++i) {
    for (size_t path = 0; path < kMisPaths; ++path) {
      const bool fromInfinity = i == 1 && p.infinite[path] != 0;
      sums.divide(path, fromInfinity ? S(1) : p.x[i - 1].dist2[path], p.x[i].normalToLight[path]);
    }
    out[i] = sums;
    scatter(kernels, mis, static_cast<uint32_t>(i), p.x[i], Walk::light, sums);
  }
  return out;
}

// The sums of the camera sub-path after arrival at x_{k-1}, ... x_0.
template <class S>
std::vector<Sums<S>> walkCamera(const MisKernels<S>& kernels, const MisSettings& mis, const SyntheticPaths<S>& p) {
  std::vector<Sums<S>> out(p.k());
  Sums<S> sums;
  for (size_t path = 0; path < kMisPaths; ++path) {
    sums.dVCM[path] = mis.camera ? static_cast<S>(mis.lightPaths) / p.camera[path] : S(0);
    sums.dVC[path] = 0;
  }
  for (size_t i = p.k(); i-- > 0;) {
    for (size_t path = 0; path < kMisPaths; ++path) {
      if (i == 0 && p.infinite[path] != 0) continue;  // values before arrival
      sums.divide(path, p.x[i].dist2[path], p.x[i].normalToCamera[path]);
    }
    out[i] = sums;
    if (i > 0) scatter(kernels, mis, static_cast<uint32_t>(p.k() - i), p.x[i], Walk::camera, sums);
  }
  return out;
}

// Weights of strategy s of all paths; merge: of merging at x_s. 0 where the strategy cannot make the path.
template <class S>
std::vector<double> weights(const MisKernels<S>& kernels, const MisSettings& mis, const SyntheticPaths<S>& p, size_t s,
                            bool merge, std::vector<Sums<S>>& light, std::vector<Sums<S>>& camera) {
  const size_t k = p.k();
  std::vector<double> out(kMisPaths, 0);
  Values<S> behindLight, behindCamera;
  const auto lightDepth = [&](size_t i) { return static_cast<uint32_t>(i); };
  const auto cameraDepth = [&](size_t i) { return static_cast<uint32_t>(k - i); };
  if (merge) {
    kernels.behindMerge(mis, kMisPaths, light[s].columns(), p.x[s].pdfToLight.data(), behindLight.data());
    kernels.behindMerge(mis, kMisPaths, camera[s].columns(), p.x[s].pdfToCamera.data(), behindCamera.data());
  } else {
    if (s >= 2 && s == k) {
      kernels.behindLens(mis, lightDepth(s - 1), kMisPaths, light[s - 1].columns(), p.x[s - 1].pdfToLight.data(),
                         behindLight.data());
    } else if (s >= 2) {
      kernels.behindConnection(mis, Walk::light, lightDepth(s - 1), kMisPaths, light[s - 1].columns(),
                               p.x[s - 1].pdfToLight.data(), behindLight.data());
    }
    if (s >= 1 && s < k) {
      kernels.behindConnection(mis, Walk::camera, cameraDepth(s), kMisPaths, camera[s].columns(),
                               p.x[s].pdfToCamera.data(), behindCamera.data());
    }
  }
  for (size_t path = 0; path < kMisPaths; ++path) {
    const bool infinite = p.infinite[path] != 0, delta = p.delta[path] != 0;
    const auto specular = [&](size_t i) { return i >= 1 && i < k && p.x[i].specular[path] != 0; };
    const S n0 = infinite ? S(1) : p.x[0].normalToCamera[path], d2 = infinite ? S(1) : p.x[0].dist2[path];
    S wLight = 0, wCamera = 0;
    if (merge) {
      if (specular(s)) continue;
      wLight = behindLight[path];
      wCamera = behindCamera[path];
    } else if (s == 0) {
      if (delta) continue;
      // A light that the camera sees has no other strategy: those of one light and one camera vertex are never used.
      if (k > 1)
        wCamera = (mis.nextEvent ? p.direct[path] * camera[0].dVCM[path] : S(0)) +
                  p.position[path] * p.direction[path] * camera[0].dVC[path];
    } else if (s == 1) {
      if (specular(1)) continue;
      const S directW = p.direct[path] * d2 / n0;
      wLight = delta || !mis.emission ? S(0) : p.x[1].pdfToLight[path] / directW;
      wCamera = p.position[path] * p.direction[path] * p.x[1].normalToLight[path] / (directW * n0) * behindCamera[path];
    } else if (s == k) {
      if (specular(k - 1)) continue;
      const S area = p.camera[path] * p.x[k - 1].normalToCamera[path] / p.x[k - 1].dist2[path];
      wLight = area / static_cast<S>(mis.lightPaths) * behindLight[path];
    } else {
      if (specular(s - 1) || specular(s)) continue;
      const S edge2 = p.x[s - 1].dist2[path];
      wLight = p.x[s].pdfToLight[path] * p.x[s - 1].normalToCamera[path] / edge2 * behindLight[path];
      wCamera = p.x[s - 1].pdfToCamera[path] * p.x[s].normalToLight[path] / edge2 * behindCamera[path];
    }
    out[path] = 1 / (1 + double{wLight} + double{wCamera});
  }
  return out;
}

// ---- from scratch ---------------------------------------------------------------------------------------------------

// Densities of all strategies of one path: connect[s], merge[i].
template <class S>
struct Densities {
  std::vector<double> connect, merge;
  double sum = 0;

  Densities(const SyntheticPaths<S>& p, size_t path, const MisSettings& mis) {
    const size_t k = p.k();
    const bool infinite = p.infinite[path] != 0;
    const auto at = [path](const Values<S>& column) { return static_cast<double>(column[path]); };
    const auto specular = [&](size_t i) { return i >= 1 && i < k && p.x[i].specular[path] != 0; };
    // A delta lobe's density in the measure eta^2 cos dw, which is the same from either side.
    const auto toCamera = [&](const SyntheticVertex<S>& v, size_t i) {
      return at(v.pdfToCamera) * (specular(i) ? at(v.etaToCamera) * at(v.etaToCamera) * at(v.shadingToCamera) : 1);
    };
    const auto toLight = [&](const SyntheticVertex<S>& v, size_t i) {
      return at(v.pdfToLight) * (specular(i) ? at(v.etaToLight) * at(v.etaToLight) * at(v.shadingToLight) : 1);
    };
    std::vector<double> fromLight(k + 1, 1), fromCamera(k + 1, 1);
    fromLight[0] = at(p.position);
    fromLight[1] = at(p.direction) * at(p.x[1].normalToLight) / (infinite ? 1 : at(p.x[0].dist2));
    for (size_t i = 1; i + 1 < k; ++i) {
      fromLight[i + 1] = toCamera(p.x[i], i) * at(p.x[i + 1].normalToLight) / at(p.x[i].dist2);
    }
    fromCamera[k - 1] = at(p.camera) * (k == 1 && infinite ? 1 : at(p.x[k - 1].normalToCamera) / at(p.x[k - 1].dist2));
    for (size_t i = k - 1; i >= 1; --i) {
      const double area = i == 1 && infinite ? 1 : at(p.x[i - 1].normalToCamera) / at(p.x[i - 1].dist2);
      fromCamera[i - 1] = toLight(p.x[i], i) * area;
    }
    const auto product = [&](size_t lightVertices, size_t firstCamera) {
      double density = 1;
      for (size_t i = 0; i < lightVertices; ++i) density *= fromLight[i];
      for (size_t i = firstCamera; i < k; ++i) density *= fromCamera[i];
      return density;
    };
    connect.assign(k + 1, 0);
    merge.assign(k + 1, 0);
    if (mis.emission && p.delta[path] == 0) connect[0] = product(0, 0);
    if (mis.nextEvent && k >= 2 && !specular(1)) connect[1] = at(p.direct) * product(0, 1);
    for (size_t s = 2; s < k && mis.connect; ++s) {
      if (!specular(s - 1) && !specular(s)) connect[s] = product(s, s);
    }
    if (mis.camera && k >= 2 && !specular(k - 1)) connect[k] = mis.lightPaths * product(k, k);
    for (size_t i = 1; i < k && mis.merge; ++i) {
      bool first = true;  // that the camera's side can merge at
      for (size_t j = i + 1; j < k; ++j) first = first && specular(j);
      if (!specular(i) && (first || !mis.firstMerges)) merge[i] = mis.vmWeight * product(i + 1, i);
    }
    for (const double density : connect) sum += density;
    for (const double density : merge) sum += density;
  }
};

struct StrategySet {
  const char* name;
  MisSettings mis;
};

std::vector<StrategySet> strategySets() {
  std::vector<StrategySet> sets{
      {"pt", {.emission = true, .nextEvent = true}},
      {"bpt", {.emission = true, .nextEvent = true, .connect = true, .camera = true}},
      {"bpm", {.emission = false, .nextEvent = false, .merge = true}},
      {"vcm", {.emission = true, .nextEvent = true, .connect = true, .camera = true, .merge = true}},
      {"vcm with first merges",
       {.emission = true, .nextEvent = true, .connect = true, .camera = true, .merge = true, .firstMerges = true}},
      {"first merges without t = 1",
       {.emission = true, .nextEvent = true, .connect = true, .camera = false, .merge = true, .firstMerges = true}},
      {"vcm without t = 1", {.emission = true, .nextEvent = true, .connect = true, .camera = false, .merge = true}},
      {"bpt without s = 1", {.emission = true, .nextEvent = false, .connect = true, .camera = true}},
      {"t = 1", {.emission = false, .nextEvent = false, .camera = true}}};
  for (StrategySet& set : sets) {
    const double density = 0.37 * 1234;  // pi r^2 N_L
    set.mis.lightPaths = 1234;
    if (set.mis.merge) set.mis.vmWeight = set.mis.connect ? density : 1;
    set.mis.vcWeight = set.mis.merge && set.mis.connect ? 1 / density : 0;
  }
  return sets;
}

class MisTest : public IsaTest {
 protected:
  template <class S>
  static void expectWeightsFromScratch(const MisKernels<S>& kernels, double tolerance) {
    std::mt19937_64 random(17);
    size_t compared = 0;
    for (const StrategySet& set : strategySets()) {
      const MisSettings& mis = set.mis;
      for (size_t k = 1; k <= 7; ++k) {
        const SyntheticPaths<S> p(k, random);
        std::vector<Sums<S>> light = walkLight(kernels, mis, p), camera = walkCamera(kernels, mis, p);
        std::vector<Densities<S>> densities;
        for (size_t path = 0; path < kMisPaths; ++path) densities.emplace_back(p, path, mis);
        std::vector<double> sums(kMisPaths, 0);
        const auto compare = [&](size_t s, bool merge) {
          const std::vector<double> w = weights(kernels, mis, p, s, merge, light, camera);
          for (size_t path = 0; path < kMisPaths; ++path) {
            const Densities<S>& d = densities[path];
            const double density = (merge ? d.merge : d.connect)[s];
            if (density == 0) continue;
            ASSERT_NEAR(w[path], density / d.sum, tolerance)
                << set.name << (merge ? ", merge at " : ", s = ") << s << ", k = " << k << ", path " << path;
            sums[path] += w[path];
            ++compared;
          }
        };
        for (size_t s = 0; s <= k; ++s) compare(s, false);
        for (size_t i = 1; i < k; ++i) compare(i, true);
        for (size_t path = 0; path < kMisPaths; ++path) {
          if (densities[path].sum > 0) {
            ASSERT_NEAR(sums[path], 1, tolerance) << set.name << ", k = " << k;
          }
        }
      }
    }
    EXPECT_GT(compared, 30'000u);
  }
};
WAVECREST_TEST_EVERY_ISA(MisTest);

TEST_P(MisTest, weightsAreThoseFromScratchInFloat) { expectWeightsFromScratch(entries<MisEntries>().floating, 1e-4); }
TEST_P(MisTest, weightsAreThoseFromScratchInDouble) { expectWeightsFromScratch(entries<MisEntries>().doubled, 1e-12); }

}  // namespace
}  // namespace wavecrest
