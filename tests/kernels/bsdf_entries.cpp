// The BSDFs behind plain pointers, for the BSDF tests. Values cross as double, whatever the precision policy.
#include "tests/kernels/bsdf_entries.h"

#include "kernels/bsdf/bsdf_lanes.h"
#include "kernels/shade/vertex_tag.h"
#include "kernels/simd/isa_table.h"

WAVECREST_SIMD_BEGIN
namespace {

// Calls function(policy) with the policy of the given precision.
template <class Function>
auto withPolicy(Precision precision, Function&& function) {
  switch (precision) {
    case Precision::doubled:
      return function(DoublePrecision{});
    default:
      return function(FloatPrecision{});
  }
}

// One block of a column; lanes past the end repeat the last value.
template <class Real, class Value>
Real loadLanes(size_t first, size_t count, Value&& value) {
  HWY_ALIGN typename Real::Storage lanes[kLanes];
  for (size_t i = 0; i < kLanes; ++i) {
    lanes[i] = static_cast<typename Real::Storage>(value(std::min(first + i, count - 1)));
  }
  return load(lanes);
}
template <class Real>
Vec3<Real> loadDirections(std::span<const Direction> from, size_t first) {
  const auto axis = [&](size_t k) { return loadLanes<Real>(first, from.size(), [&](size_t i) { return from[i][k]; }); };
  return {axis(0), axis(1), axis(2)};
}
// Calls assign(item, value) for the lanes of a that are items of the batch.
template <class Real, class Assign>
void storeLanes(Real a, size_t first, size_t count, Assign&& assign) {
  HWY_ALIGN typename Real::Storage lanes[kLanes];
  store(a, lanes);
  for (size_t i = 0; i < kLanes && first + i < count; ++i) assign(first + i, double{lanes[i]});
}
template <class Real, class Assign>
void storeLanes(Vec3<Real> a, size_t first, size_t count, Assign&& assign) {
  storeLanes(a.x, first, count, [&](size_t i, double x) { assign(i, size_t{0}, x); });
  storeLanes(a.y, first, count, [&](size_t i, double x) { assign(i, size_t{1}, x); });
  storeLanes(a.z, first, count, [&](size_t i, double x) { assign(i, size_t{2}, x); });
}

template <class P>
SceneView<typename P::Storage> sceneOf(const BsdfQuery& query) {
  SceneView<typename P::Storage> scene;
  scene.materials = query.material;
  scene.compounds = query.compounds;
  scene.materialCount = 1;
  return scene;
}
template <class P>
BsdfInputOf<P, kAllFeatures> inputOf(const SceneView<typename P::Storage>& scene, const BsdfQuery& query) {
  using Real = typename P::Real;
  BsdfInputOf<P, kAllFeatures> input(scene, UInt(0u));
  input.walk = query.walk;
  input.lobes = query.specularOnly ? Lobes::specularOnly : Lobes::all;
  if constexpr (has(kAllFeatures, kCompoundBsdfs)) {
    input.tangentX = Real(kTangent[0]);
    input.tangentY = Real(kTangent[1]);
  }
  return input;
}

template <class P>
void evalBlocks(const BsdfQuery& query, std::span<const Direction> wi, std::span<const Direction> wo,
                BsdfEvaluation* out) {
  using Real = typename P::Real;
  const SceneView<typename P::Storage> scene = sceneOf<P>(query);
  const BsdfInputOf<P, kAllFeatures> input = inputOf<P>(scene, query);
  for (size_t i = 0; i < wi.size(); i += kLanes) {
    const auto value = evalBsdf<P, kAllFeatures>(input, firstLanes(wi.size() - i), loadDirections<Real>(wi, i),
                                                 loadDirections<Real>(wo, i));
    storeLanes(value.f, i, wi.size(), [&](size_t item, size_t k, double x) { out[item].f[k] = x; });
    storeLanes(value.pdf, i, wi.size(), [&](size_t item, double x) { out[item].pdf = x; });
    storeLanes(value.pdfReverse, i, wi.size(), [&](size_t item, double x) { out[item].pdfReverse = x; });
  }
}

template <class P>
void sampleBlocks(const BsdfQuery& query, std::span<const Direction> wi, std::span<const std::array<float, 3>> u,
                  BsdfDraw* out) {
  using Real = typename P::Real;
  const SceneView<typename P::Storage> scene = sceneOf<P>(query);
  const BsdfInputOf<P, kAllFeatures> input = inputOf<P>(scene, query);
  const size_t count = wi.size();
  for (size_t i = 0; i < count; i += kLanes) {
    const auto number = [&](size_t k) { return loadLanes<Float>(i, count, [&](size_t item) { return u[item][k]; }); };
    const auto draw = sampleBsdf<P, kAllFeatures>(input, firstLanes(count - i), loadDirections<Real>(wi, i),
                                                  {number(0), number(1), number(2), Float(0.5f)});
    storeLanes(draw.wo, i, count, [&](size_t item, size_t k, double x) { out[item].wo[k] = x; });
    storeLanes(draw.weight, i, count, [&](size_t item, size_t k, double x) { out[item].weight[k] = x; });
    storeLanes(draw.pdf, i, count, [&](size_t item, double x) { out[item].pdf = x; });
    storeLanes(draw.pdfReverse, i, count, [&](size_t item, double x) { out[item].pdfReverse = x; });
    storeLanes(draw.etaRatio, i, count, [&](size_t item, double x) { out[item].etaRatio = x; });
    const Float specular = zeroUnless(draw.specular, Float(1));
    storeLanes(specular, i, count, [&](size_t item, double x) { out[item].specular = x != 0; });
  }
}

template <class Real>
double firstLane(Real a) {
  double first = 0;
  storeLanes(a, 0, 1, [&](size_t, double x) { first = x; });
  return first;
}

constexpr BsdfEntries kEntries = {
    .lanes = kLanes,
    .eval =
        [](const BsdfQuery& query, std::span<const Direction> wi, std::span<const Direction> wo, BsdfEvaluation* out) {
          withPolicy(query.precision, [&](auto policy) { evalBlocks<decltype(policy)>(query, wi, wo, out); });
        },
    .sample =
        [](const BsdfQuery& query, std::span<const Direction> wi, std::span<const std::array<float, 3>> u,
           BsdfDraw* out) {
          withPolicy(query.precision, [&](auto policy) { sampleBlocks<decltype(policy)>(query, wi, u, out); });
        },
    .readMaterials =
        [](const SceneView<float>& scene, const uint32_t* index, uint32_t element, MaterialWords* out) {
          const MaterialLanes material(scene, loadUnaligned(index));
          const auto* const words = reinterpret_cast<const uint32_t*>(scene.materials);
          for (size_t w = 0; w < MaterialTable::kWords; ++w) storeUnaligned(material(words[w]), out->words[w]);
          storeUnaligned(material(scene.materials->roughTransmittance, UInt(element)), out->transmittance);
          const Vec3<Float> specular = material(scene.materials->specular);
          storeUnaligned(specular.x, out->specular[0]);
          storeUnaligned(specular.y, out->specular[1]);
          storeUnaligned(specular.z, out->specular[2]);
          const FourColumns<Float> reflectance = material.four(scene.materials->reflectance[0]);
          storeUnaligned(reflectance.a, out->reflectance[0]);
          storeUnaligned(reflectance.b, out->reflectance[1]);
          storeUnaligned(reflectance.c, out->reflectance[2]);
          storeUnaligned(reflectance.d, out->reflectance[3]);
        },
    .readPrimitives =
        [](const SceneView<float>& scene, const uint32_t* index, PrimitiveWords* out) {
          const auto at = primitivesOf(scene, loadUnaligned(index));
          const auto* const words = reinterpret_cast<const uint32_t*>(scene.primitives);
          for (size_t w = 0; w < PrimitiveTable::kWords; ++w) storeUnaligned(at(words[w]), out->words[w]);
          const Vec3<Float> normal = at(scene.primitives->normal);
          storeUnaligned(normal.x, out->normal[0]);
          storeUnaligned(normal.y, out->normal[1]);
          storeUnaligned(normal.z, out->normal[2]);
        },
    .throughTag =
        [](Precision precision, uint32_t material, uint32_t edges) {
          return withPolicy(precision, [&](auto policy) HWY_ATTR {
            using Real = typename decltype(policy)::Real;
            const Real tag = packTag(UInt(material), edges, Real(0));
            HWY_ALIGN uint32_t materials[kLanes];
            store(materialOfTag(tag), materials);
            return std::array{materials[0], static_cast<uint32_t>(firstLane(edgesOfTag(tag)))};
          });
        },
    .fresnelDielectric =
        [](Precision precision, double cosine, double eta) {
          return withPolicy(precision, [&](auto policy) HWY_ATTR {
            using P = decltype(policy);
            using Real = typename P::Real;
            return firstLane(fresnelDielectric<P>(Real(cosine), Real(eta)).reflectance);
          });
        },
    .fresnelConductor =
        [](Precision precision, double cosine, double eta, double k) {
          return withPolicy(precision, [&](auto policy) HWY_ATTR {
            using P = decltype(policy);
            using Real = typename P::Real;
            return firstLane(fresnelConductor<P>(Real(cosine), Real(eta), Real(k)));
          });
        },
};
WAVECREST_REGISTER_ENTRIES(BsdfEntries, kEntries);

}  // namespace
WAVECREST_SIMD_END
