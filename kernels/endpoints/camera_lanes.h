// Camera rays in lanes: pinhole, lens and parallel rays; the camera decides.
#pragma once

#include <cmath>

#include "kernels/lane_support.h"
#include "kernels/sampling/warp_lanes.h"
#include "kernels/simd/math.h"

WAVECREST_SIMD_BEGIN

template <class Real>
struct RayLanes {
  Vec3<Real> origin, direction;
};

// Turns uniform numbers into an offset from the pixel's corner that is distributed like the reconstruction filter, so
// that each sample has weight 1 (Ernst et al., "Filter Importance Sampling", 2006).
template <class Real>
WAVECREST_INLINE void filterOffset(const CameraView& camera, Real& x, Real& y) {
  if (camera.filter == FilterKind::tent) {
    const auto tent = [&](Real u) WAVECREST_LAMBDA {
      const Real rising = sqrt(u + u) - Real(1), falling = Real(1) - sqrt(max(Real(2) - u - u, Real(0)));
      return mulAdd(select(u < Real(0.5f), rising, falling), Real(camera.filterScale), Real(0.5f));
    };
    x = tent(x);
    y = tent(y);
  } else if (camera.filter == FilterKind::gaussian) {
    const Real radius = sqrt(Real(-2) * log(Real(1) - x)) * Real(camera.filterScale);  // Box and Muller 1958
    const auto angle = sinCos2Pi(y);
    x = mulAdd(radius, angle.cos, Real(0.5f));
    y = mulAdd(radius, angle.sin, Real(0.5f));
  }
}

// The place in the filter, from the pixel's corner, that all camera paths of an iteration share. ahead: iterations
// beyond the sampler's.
//
// Places are Sobol points whatever the sampler: one place for the whole image would otherwise shift its edges by the
// noise of a mean of independent numbers. An odd iteration has the place of the one before, mirrored at the pixel's
// centre: at the film's edge, where the one leaves pixels with few samples, the other has many.
template <class Real>
WAVECREST_INLINE Vec2<Real> sharedPlace(const CameraView& camera, const SamplerSettings& sampler, UInt ahead) {
  SamplerSettings pairs = sampler;
  pairs.kind = SamplerKind::sobol;
  pairs.iteration /= 2;
  const UInt number = ahead + UInt(static_cast<uint32_t>(sampler.iteration & 1));
  const UInt pair = shiftLeft<kPathBits>(shiftRight<1>(number));
  const Uniform4 u = uniform4(pairs, pair, static_cast<uint32_t>(Block::scatter), Stream::filter);
  Vec2<Real> place{to<Real>(u.a), to<Real>(u.b)};
  filterOffset(camera, place.x, place.y);
  const Mask mirrored = hasBit(number, 0);
  return {select(mirrored, Real(1) - place.x, place.x), select(mirrored, Real(1) - place.y, place.y)};
}

// Uniform on the lens, relative to its centre.
template <class Real>
WAVECREST_INLINE Vec3<Real> lensOffset(const CameraView& camera, Real u, Real v) {
  const Vec2<Real> lens = concentricDisc<Real>(u, v);
  const double scaleU = camera.lensRadius * std::sqrt(camera.inverseDu2);
  const double scaleV = camera.lensRadius * std::sqrt(camera.inverseDv2);
  return broadcast<Real>(camera.du) * (lens.x * Real(scaleU)) + broadcast<Real>(camera.dv) * (lens.y * Real(scaleV));
}

// The way along a ray from the lens to the near clip.
template <class Real>
WAVECREST_INLINE Real toNearClip(const CameraView& camera, Vec3<Real> direction) {
  return Real(camera.nearClip) / dot(direction, broadcast<Real>(camera.axis));
}
// Rays begin at the near clip, which hides what lies before it.
template <class Real>
WAVECREST_INLINE RayLanes<Real> fromNearClip(const CameraView& camera, const RayLanes<Real>& ray) {
  if (camera.nearClip == 0) return ray;
  return {mulAdd(ray.direction, toNearClip(camera, ray.direction), ray.origin), ray.direction};
}
// Where on the lens a ray came from that begins at the near clip.
template <class Real>
WAVECREST_INLINE Vec3<Real> lensOf(const CameraView& camera, Vec3<Real> origin, Vec3<Real> direction) {
  return mulAdd(direction, -toNearClip(camera, direction), origin);
}

// The ray through a raster position; lensU, lensV: uniform numbers for the place on the lens.
template <class P>
WAVECREST_INLINE RayLanes<typename P::Real> cameraRayAt(const CameraView& camera, typename P::Real rasterX,
                                                        typename P::Real rasterY, Float lensU, Float lensV) {
  using Real = typename P::Real;
  if (camera.parallel) {
    const Vec3<Real> origin = mulAdd(broadcast<Real>(camera.du), rasterX,
                                     mulAdd(broadcast<Real>(camera.dv), rasterY, broadcast<Real>(camera.origin)));
    return {origin, broadcast<Real>(camera.axis)};
  }
  const Vec3<Real> onPlane = mulAdd(broadcast<Real>(camera.du), rasterX,
                                    mulAdd(broadcast<Real>(camera.dv), rasterY, broadcast<Real>(camera.corner)));
  const Vec3<Real> origin = broadcast<Real>(camera.origin);
  if (camera.lensRadius > 0) {
    // Through the point of the plane in focus that the ray by the lens's centre would meet.
    const Vec3<Real> onLens = lensOffset(camera, to<Real>(lensU), to<Real>(lensV));
    const Vec3<Real> inFocus = onPlane * Real(camera.focusDistance / camera.planeDepth);
    return fromNearClip<Real>(camera, {origin + onLens, normalize(inFocus - onLens)});
  }
  return fromNearClip<Real>(camera, {origin, normalize(onPlane)});
}

// A ray of a pixel through a place, from the pixel's corner.
template <class P>
WAVECREST_INLINE RayLanes<typename P::Real> cameraRay(const CameraView& camera, const PixelLanes& pixel,
                                                      Vec2<typename P::Real> place, Float lensU, Float lensV) {
  using Real = typename P::Real;
  return cameraRayAt<P>(camera, to<Real>(toFloat(pixel.x)) + place.x, to<Real>(toFloat(pixel.y)) + place.y, lensU,
                        lensV);
}

// Parallel rays of one pixel per area across them: each of its points sends one ray. METHODS 4.4.
inline double parallelPdf(const CameraView& camera) { return std::sqrt(camera.inverseDu2 * camera.inverseDv2); }

// Density per solid angle of the camera rays of one pixel: D^2 / cos^3, D the distance in pixels at which a pixel has
// area 1 (METHODS 4.1). Of parallel rays per area across them: arrive multiplies by no d^2 then.
template <class P>
WAVECREST_INLINE typename P::Real cameraPdf(const CameraView& camera, Vec3<typename P::Real> direction) {
  using Real = typename P::Real;
  if (camera.parallel) return Real(parallelPdf(camera));
  const Real cosine = dot(direction, broadcast<Real>(camera.axis));
  return Real(camera.pixelDistance * camera.pixelDistance) / (cosine * cosine * cosine);
}

// Where a point is seen from a point of the lens: raster position, and density per area of the pixel's rays at the
// point, without the cosine there. A thin lens's own density cancels between the lens point's and the filter's (METHODS
// 4.2): the density is the pinhole's. Parallel rays meet a point from one place.
template <class Real>
struct Projection {
  Real rasterX, rasterY;
  Vec3<Real> direction;  // unit, from the point to the lens
  Vec3<Real> end;        // the point on the lens, or before it on the near clip
  Real pdf;              // D^2 / (cos^3 d^2), or 1 / pixel area
  Mask inFront;
};
// u.a, u.b: place on the lens.
template <class P>
WAVECREST_INLINE Projection<typename P::Real> project(const CameraView& camera, Vec3<typename P::Real> point,
                                                      const Uniform4& u) {
  using Real = typename P::Real;
  Projection<Real> out;
  if (camera.parallel) {
    const Vec3<Real> axis = broadcast<Real>(camera.axis), fromCorner = point - broadcast<Real>(camera.origin);
    const Real along = dot(fromCorner, axis);
    return {.rasterX = dot(fromCorner, broadcast<Real>(camera.du)) * Real(camera.inverseDu2),
            .rasterY = dot(fromCorner, broadcast<Real>(camera.dv)) * Real(camera.inverseDv2),
            .direction = -axis,
            .end = mulAdd(axis, -along, point),
            .pdf = Real(parallelPdf(camera)),
            .inFront = (along > Real(0)) & (along <= Real(camera.farClip))};
  }
  Vec3<Real> lens = broadcast<Real>(camera.origin);
  Vec3<Real> onLens{Real(0), Real(0), Real(0)};
  // The image plane, corner + x du + y dv, is at planeDepth along the axis; where the ray meets the plane in focus,
  // seen from the lens's centre, is the raster position. A pinhole has every plane in focus.
  double focus = camera.planeDepth;
  if (camera.lensRadius > 0) {
    onLens = lensOffset(camera, to<Real>(u.a), to<Real>(u.b));
    lens = lens + onLens;
    focus = camera.focusDistance;
  }
  const Vec3<Real> fromLens = point - lens;
  const Real dist2 = length2(fromLens);
  const Real inverseDistance = reciprocalSqrt(max(dist2, Real(1e-37f)));
  out.direction = fromLens * -inverseDistance;
  const Real along = dot(fromLens, broadcast<Real>(camera.axis));
  out.inFront = (along > Real(camera.nearClip)) & (along <= Real(camera.farClip));
  out.end = lens;
  if (camera.nearClip > 0) out.end = mulAdd(fromLens, Real(camera.nearClip) / along, lens);
  const Vec3<Real> inFocus = onLens + fromLens * (Real(focus) / along);
  const Vec3<Real> onPlane = inFocus * Real(camera.planeDepth / focus) - broadcast<Real>(camera.corner);
  out.rasterX = dot(onPlane, broadcast<Real>(camera.du)) * Real(camera.inverseDu2);
  out.rasterY = dot(onPlane, broadcast<Real>(camera.dv)) * Real(camera.inverseDv2);
  const Real inverseCosine = reciprocal(along * inverseDistance);
  out.pdf = Real(camera.pixelDistance * camera.pixelDistance) * inverseCosine * inverseCosine * inverseCosine *
            inverseDistance * inverseDistance;
  return out;
}

// The pixel that a splat goes to, along one axis, and what its value is multiplied by.
//
// A filter h spreads a contribution at raster r over all pixels j with h(r - centre_j) > 0. One of them is taken with
// that probability, so a splat stays one value and one shadow ray; the weight is the sum over pixels, which differs
// from 1 only as far as the filter's samples on the raster do. generate draws its rays from the same h.
template <class Real>
struct SplatPixel {
  Real pixel, weight;
};
template <class Real>
WAVECREST_INLINE SplatPixel<Real> splatPixel(const CameraView& camera, Real raster, Real u) {
  const Real nearest = floor(raster), zero(0), one(1);
  if (camera.filter == FilterKind::box) return {nearest, one};
  const bool tent = camera.filter == FilterKind::tent;
  const Real x = raster - nearest - Real(0.5f);
  const double inverseScale = 1 / camera.filterScale;
  // Three exponentials make all of a Gaussian: the ratio of one pixel to the one before is multiplied by the same
  // number at every step, and that is the product of the first ratios up and down.
  const double radius = filterRadius(camera);
  const int reach = static_cast<int>(radius + 0.5);
  Real centre(0), ratioUp(0), ratioDown(0);
  if (!tent) {
    const Real scaled = x * Real(inverseScale);
    centre = exp(scaled * scaled * Real(-0.5)) * Real(inverseScale / std::sqrt(2 * kPi));
    const Real half(0.5 * inverseScale * inverseScale);
    ratioUp = exp(mulAdd(scaled, Real(inverseScale), -half));
    ratioDown = exp(negMulAdd(scaled, Real(inverseScale), -half));
  }
  const Real perStep = ratioUp * ratioDown;
  // Calls visit(step, weight) for the pixels that the filter reaches: the nearest, those above it, those below.
  const auto forEachPixel = [&](const auto& visit) WAVECREST_LAMBDA {
    const auto tentAt = [&](int step) WAVECREST_LAMBDA {
      const Real away = abs(x - Real(static_cast<float>(step))) * Real(inverseScale);
      return max(one - away, zero) * Real(inverseScale);
    };
    visit(zero, tent ? tentAt(0) : centre);
    for (const int direction : {1, -1}) {
      Real weight = centre, ratio = direction == 1 ? ratioUp : ratioDown;
      for (int step = direction; step * direction <= reach; step += direction) {
        weight = tent ? tentAt(step) : weight * ratio;
        ratio = ratio * perStep;
        visit(Real(static_cast<float>(step)), weight);
      }
    }
  };
  Real sum(0), below(0), chosen(0);
  forEachPixel([&](Real, Real weight) WAVECREST_LAMBDA { sum = sum + weight; });
  const Real wanted = u * sum;
  forEachPixel([&](Real step, Real weight) WAVECREST_LAMBDA {
    chosen = select(below <= wanted, step, chosen);
    below = below + weight;
  });
  return {nearest + chosen, sum};
}

WAVECREST_SIMD_END
