// The warps behind plain pointers, for warp_test.cpp.
#include "tests/kernels/warp_entries.h"

#include "kernels/sampling/warp_lanes.h"
#include "kernels/simd/isa_table.h"

WAVECREST_SIMD_BEGIN
namespace {

template <class T>
using RealOf = decltype(loadUnaligned(static_cast<const T*>(nullptr)));

// sample(u, v, parameter) gives a point; density(point, parameter) its pdf.
template <class T, class Sample, class Density>
WAVECREST_INLINE void run(const T* u, const T* v, T parameter, T* x, T* y, T* z, T* pdf, size_t count, Sample sample,
                          Density density) {
  const RealOf<T> p(parameter);
  for (size_t i = 0; i < count; i += kLanes) {
    const Vec3<RealOf<T>> point = sample(loadUnaligned(u + i), loadUnaligned(v + i), p);
    storeUnaligned(point.x, x + i);
    storeUnaligned(point.y, y + i);
    storeUnaligned(point.z, z + i);
    storeUnaligned(density(point, p), pdf + i);
  }
}

// A table row from two expressions: of u, v and p (the parameter), and of point and p.
#define WAVECREST_WARP(POINT, PDF)                                                                                \
  [](const T* pu, const T* pv, T parameter, T* x, T* y, T* z, T* pdf, size_t count) HWY_ATTR {                    \
    run(                                                                                                          \
        pu, pv, parameter, x, y, z, pdf, count,                                                                   \
        []([[maybe_unused]] Real u, [[maybe_unused]] Real v, [[maybe_unused]] Real p) HWY_ATTR { return POINT; }, \
        []([[maybe_unused]] Vec3<Real> point, [[maybe_unused]] Real p) HWY_ATTR { return PDF; });                 \
  }

template <class Real>
WAVECREST_INLINE Vec3<Real> planar(Vec2<Real> a) {
  return {a.x, a.y, Real(0)};
}

template <class T>
constexpr WarpFunctions<T> makeFunctions() {
  using Real = RealOf<T>;
  return {
      .concentricDisc = WAVECREST_WARP(planar(concentricDisc(u, v)), concentricDiscPdfA<Real>()),
      .cosineHemisphere = WAVECREST_WARP(cosineHemisphere(u, v), cosineHemispherePdfW(point.z)),
      .uniformSphere = WAVECREST_WARP(uniformSphere(u, v), uniformSpherePdfW<Real>()),
      .uniformCone = WAVECREST_WARP(uniformCone(u, v, oneMinusCosFromSin2(p)), uniformConePdfW(oneMinusCosFromSin2(p))),
      .uniformTriangle = WAVECREST_WARP(planar(uniformTriangle(u, v)), uniformTrianglePdfA(p))};
}

constexpr WarpEntries kWarpEntries = {
    .lanes = kLanes, .floats = makeFunctions<float>(), .doubles = makeFunctions<double>()};
WAVECREST_REGISTER_ENTRIES(WarpEntries, kWarpEntries);

}  // namespace
WAVECREST_SIMD_END
