// Texture lookup in lanes.
#pragma once

#include "kernels/lane_support.h"

WAVECREST_SIMD_BEGIN

namespace {

// Texel index along one axis after wrapping; x is an integer-valued float.
WAVECREST_INLINE UInt wrapped(Float x, UInt size, UInt wrap) {
  const Float extent = toFloat(size);
  const Float period = select(wrap == UInt(static_cast<uint32_t>(WrapMode::mirror)), extent + extent, extent);
  Float inside = x - floor(x / period) * period;
  inside = select(inside >= extent, period - Float(1) - inside, inside);  // the way back of a mirrored period
  const Float clamped = min(max(x, Float(0)), extent - Float(1));
  inside = select(wrap == UInt(static_cast<uint32_t>(WrapMode::clamp)), clamped, inside);
  return min(toUInt(max(inside, Float(0))), size - UInt(1u));
}

WAVECREST_INLINE Vec3<Float> texel(const float* texels, UInt offset, UInt width, UInt x, UInt y) {
  const UInt at = offset + (y * width + x) * UInt(3u);
  return {gather(texels, at), gather(texels + 1, at), gather(texels + 2, at)};
}

}  // namespace

// The textures with the given ids at (u, v); every id must be valid. Bilinear between texel centres or nearest, as
// Mitsuba's bitmap; checkerboard cells are half a unit wide.
WAVECREST_NOINLINE inline Vec3<Float> evalTexture(const TextureRecord* textures, const float* texels, UInt id, Float u,
                                                  Float v) {
  const RecordLanes<TextureRecord> at(textures, id);
  const Float s = mulAdd(at(textures->toUv[0]), u, mulAdd(at(textures->toUv[1]), v, at(textures->toUv[2])));
  const Float t = mulAdd(at(textures->toUv[3]), u, mulAdd(at(textures->toUv[4]), v, at(textures->toUv[5])));

  const Mask even = ((s - floor(s)) > Float(0.5f)) ^ ((t - floor(t)) > Float(0.5f));
  Vec3<Float> value = select(even, at(textures->color1), at(textures->color0));
  const Mask bitmap = at(textures->kind) == UInt(static_cast<uint32_t>(TextureKind::bitmap));
  if (none(bitmap)) return value;

  const UInt width = max(at(textures->width), UInt(1u)), height = max(at(textures->height), UInt(1u));
  const UInt wrap = at(textures->wrap), offset = select(bitmap, at(textures->offset), UInt(0u));
  const Mask nearest = at(textures->nearest) == UInt(1u);
  const Float half = zeroUnless(!nearest, Float(0.5f));
  const Float x = s * toFloat(width) - half, y = t * toFloat(height) - half;
  const Float x0 = floor(x), y0 = floor(y);
  const Float fx = zeroUnless(!nearest, x - x0), fy = zeroUnless(!nearest, y - y0);
  const UInt left = wrapped(x0, width, wrap), right = wrapped(x0 + Float(1), width, wrap);
  const UInt top = wrapped(y0, height, wrap), bottom = wrapped(y0 + Float(1), height, wrap);
  const Vec3<Float> upper =
      texel(texels, offset, width, left, top) * (Float(1) - fx) + texel(texels, offset, width, right, top) * fx;
  const Vec3<Float> lower =
      texel(texels, offset, width, left, bottom) * (Float(1) - fx) + texel(texels, offset, width, right, bottom) * fx;
  return select(bitmap, upper * (Float(1) - fy) + lower * fy, value);
}

// The texture in one slot of each lane's material: 1 where the slot, or the whole scene (textures null), has none.
WAVECREST_INLINE Vec3<Float> textureFactor(const TextureRecord* textures, const float* texels, UInt id, Float u,
                                           Float v) {
  const Float one(1);
  const Mask textured = id != UInt(kNoIndex);
  if (textures == nullptr || none(textured)) return {one, one, one};
  const Vec3<Float> value = evalTexture(textures, texels, select(textured, id, UInt(0u)), u, v);
  return select(textured, value, {one, one, one});
}

WAVECREST_SIMD_END
