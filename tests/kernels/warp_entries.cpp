// The warps behind plain pointers, for warp_test.cpp.
#include "tests/kernels/warp_entries.h"

#include "kernels/sampling/warp_lanes.h"
#include "kernels/simd/isa_table.h"

WAVECREST_SIMD_BEGIN
namespace {

template <class T>
using RealOf = decltype(loadUnaligned(static_cast<const T*>(nullptr)));

// sample(u, v, parameter) gives a point, heightOf(parameter) the height.
template <class T, class Sample, class HeightOf>
WAVECREST_INLINE void run(const T* u, const T* v, T parameter, T* x, T* y, T* z, T* height, size_t count, Sample sample,
                          HeightOf heightOf) {
  const RealOf<T> p(parameter);
  for (size_t i = 0; i < count; i += kLanes) {
    const Vec3<RealOf<T>> point = sample(loadUnaligned(u + i), loadUnaligned(v + i), p);
    storeUnaligned(point.x, x + i);
    storeUnaligned(point.y, y + i);
    storeUnaligned(point.z, z + i);
    storeUnaligned(heightOf(p), height + i);
  }
}

// A table row from two expressions: of u, v and p (the parameter), and of p.
#define WAVECREST_WARP(POINT, HEIGHT)                                                                             \
  [](const T* pu, const T* pv, T parameter, T* x, T* y, T* z, T* height, size_t count) HWY_ATTR {                 \
    run(                                                                                                          \
        pu, pv, parameter, x, y, z, height, count,                                                                \
        []([[maybe_unused]] Real u, [[maybe_unused]] Real v, [[maybe_unused]] Real p) HWY_ATTR { return POINT; }, \
        []([[maybe_unused]] Real p) HWY_ATTR { return HEIGHT; });                                                 \
  }

template <class Real>
WAVECREST_INLINE Vec3<Real> planar(Vec2<Real> a) {
  return {a.x, a.y, Real(0)};
}
template <class Real>
WAVECREST_INLINE Vec3<Real> folded(Real u, Real v) {
  foldOntoTriangle(allLanes(), u, v);
  return {u, v, Real(0)};
}

template <class T>
constexpr WarpFunctions<T> makeFunctions() {
  using Real = RealOf<T>;
  return {.concentricDisc = WAVECREST_WARP(planar(concentricDisc(u, v)), Real(0)),
          .cosineHemisphere = WAVECREST_WARP(cosineHemisphere(u, v), Real(0)),
          .uniformSphere = WAVECREST_WARP(uniformSphere(u, v), Real(0)),
          .uniformCone = WAVECREST_WARP(uniformCone(u, v, oneMinusCosFromSin2(p)), oneMinusCosFromSin2(p)),
          .uniformTriangle = WAVECREST_WARP(folded(u, v), Real(0))};
}

constexpr WarpEntries kWarpEntries = {
    .lanes = kLanes, .floats = makeFunctions<float>(), .doubles = makeFunctions<double>()};
WAVECREST_REGISTER_ENTRIES(WarpEntries, kWarpEntries);

}  // namespace
WAVECREST_SIMD_END
