// generate: starts one camera path per lane of the wave.
//
// in: the pixels of paths [firstPath, firstPath + pathCount), or none for paths that choose them. out: Rays, PathStates
// [pathCount], in lane order; Radiance set to zero. The raster position is distributed like the reconstruction filter
// around the pixel, so W_j cos / p = 1 and the throughput begins at 1.
#include "kernels/endpoints/camera_lanes.h"
#include "kernels/mis_lanes.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

namespace {

// The pixel of each lane's path, its place in the pixel (u.a, u.b) and on the lens (u.c, u.d).
struct CameraSample {
  PixelLanes pixel;
  Uniform4 u;
};
template <class S>
WAVECREST_INLINE CameraSample cameraSample(const StageContext<S>& context, const Wave<S>& wave, UInt lane) {
  if (context.pixels != nullptr) [[likely]] {
    const PixelLanes pixel = pixelsOf(context, wave, lane);
    return {pixel, draw(context, pixel.path, Block::scatter)};
  }
  // u.a, u.b: place in the whole rectangle. Numbers have 24 bits, of which the pixel takes the upper ones.
  Uniform4 u = draw(context, lane, Block::scatter);
  const FilmWindow& film = context.film;
  const auto split = [](Float number, uint32_t size, Float& rest) WAVECREST_LAMBDA {
    const Float place = number * Float(static_cast<float>(size));
    const UInt whole = min(toUInt(place), UInt(size - 1));
    rest = place - toFloat(whole);
    return whole;
  };
  const UInt x = split(u.a, film.width, u.a), y = split(u.b, film.height, u.b);
  return {{x + UInt(film.x0), y + UInt(film.y0), lane}, u};
}

template <class S>
WAVECREST_INLINE void recordPixel(const StageContext<S>& context, const PixelLanes& pixel, size_t i) {
  const FilmWindow& film = context.film;
  const UInt index = (pixel.y - UInt(film.y0)) * UInt(film.width) + pixel.x - UInt(film.x0);
  store(index, context.lanes.pixel, i);
}

}  // namespace

template <class P, uint32_t kFeatures>
void generateCameraPaths(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  using Real = typename P::Real;
  const size_t count = wave.pathCount;
  wave.rays.size = wave.paths.size = wave.radiance.size = 0;
  wave.rays.claim(count);
  wave.paths.claim(count);
  wave.radiance.claim(count);

  const UInt aheadMask((1u << wave.iterationBits) - 1);
  for (size_t i = 0; i < count; i += kLanes) {
    const UInt lane = min(laneIndex(static_cast<uint32_t>(i)), UInt(static_cast<uint32_t>(count - 1)));
    const CameraSample sample = cameraSample(context, wave, lane);
    if (context.lanes.pixel != nullptr) recordPixel(context, sample.pixel, i);
    const PixelLanes& pixel = sample.pixel;
    const Uniform4& u = sample.u;
    Vec2<Real> place{to<Real>(u.a), to<Real>(u.b)};
    if (context.sharedPlace) {
      place = sharedPlace<Real>(context.scene->camera, context.sampler, lane & aheadMask);
    } else {
      filterOffset(context.scene->camera, place.x, place.y);
    }
    const auto ray = cameraRay<P>(context.scene->camera, pixel, place, u.c, u.d);

    storeVec3(ray.origin, wave.rays.originX, wave.rays.originY, wave.rays.originZ, i);
    storeVec3(ray.direction, wave.rays.directionX, wave.rays.directionY, wave.rays.directionZ, i);
    const Vec3<Real> one{Real(1), Real(1), Real(1)}, zero{Real(0), Real(0), Real(0)};
    storeVec3(one, wave.paths.throughputR, wave.paths.throughputG, wave.paths.throughputB, i);
    storeVec3(zero, wave.radiance.red, wave.radiance.green, wave.radiance.blue, i);
    // t = 1 would have found this edge with density p_cam per light path that a pixel's camera path competes with;
    // without that strategy the recursion starts from nothing.
    MisSums<Real> mis{Real(0), Real(0)};
    if constexpr (has(kFeatures, kBidirectional)) {
      if (context.mis.camera)
        mis.dVCM = Real(context.mis.lightPaths) / cameraPdf<P>(context.scene->camera, ray.direction);
    }
    storeMis<kFeatures>(mis, wave.paths, i);
    if constexpr (hasRouletteScale(kFeatures)) store(Real(1), wave.paths.rouletteScale, i);
    store(laneIndex(static_cast<uint32_t>(i)), wave.paths.lane, i);
  }
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_STAGE(generateCameraPaths)
