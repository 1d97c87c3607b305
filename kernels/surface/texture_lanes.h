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

// Where in its matrix a texture is read: (s, t) of (u, v).
struct TexturePoint {
  Float s, t;
};
WAVECREST_INLINE TexturePoint texturePoint(const TextureRecord* textures, const RecordLanes<TextureRecord>& at, Float u,
                                           Float v) {
  return {mulAdd(at(textures->toUv[0]), u, mulAdd(at(textures->toUv[1]), v, at(textures->toUv[2]))),
          mulAdd(at(textures->toUv[3]), u, mulAdd(at(textures->toUv[4]), v, at(textures->toUv[5])))};
}

// The four texels of a bitmap around a point, each as the index of its first channel, and the place of the point
// between them: x from left to right and y from top to bottom, 0 to 1. Both are 0 where the nearest texel is taken.
struct TexelCell {
  UInt topLeft, topRight, bottomLeft, bottomRight;
  Float x, y;
};
WAVECREST_INLINE TexelCell texelCell(const TextureRecord* textures, const RecordLanes<TextureRecord>& at, Mask bitmap,
                                     TexturePoint point) {
  const UInt width = max(at(textures->width), UInt(1u)), height = max(at(textures->height), UInt(1u));
  const UInt wrap = at(textures->wrap), offset = select(bitmap, at(textures->offset), UInt(0u));
  const Mask nearest = at(textures->nearest) == UInt(1u);
  const Float half = zeroUnless(!nearest, Float(0.5f));
  const Float x = point.s * toFloat(width) - half, y = point.t * toFloat(height) - half;
  const Float x0 = floor(x), y0 = floor(y);
  const UInt left = wrapped(x0, width, wrap), right = wrapped(x0 + Float(1), width, wrap);
  const UInt top = wrapped(y0, height, wrap), bottom = wrapped(y0 + Float(1), height, wrap);
  const auto index = [&](UInt column, UInt row) WAVECREST_LAMBDA { return offset + (row * width + column) * UInt(3u); };
  return {index(left, top),
          index(right, top),
          index(left, bottom),
          index(right, bottom),
          zeroUnless(!nearest, x - x0),
          zeroUnless(!nearest, y - y0)};
}

WAVECREST_INLINE Vec3<Float> texel(const float* texels, UInt at) {
  return {gather(texels, at), gather(texels + 1, at), gather(texels + 2, at)};
}

}  // namespace

// The textures with the given ids at (u, v); every id must be valid. Bilinear between texel centres or nearest, as
// Mitsuba's bitmap; checkerboard cells are half a unit wide.
WAVECREST_NOINLINE inline Vec3<Float> evalTexture(const TextureRecord* textures, const float* texels, UInt id, Float u,
                                                  Float v) {
  const RecordLanes<TextureRecord> at(textures, id);
  const TexturePoint point = texturePoint(textures, at, u, v);
  const Mask even = ((point.s - floor(point.s)) > Float(0.5f)) ^ ((point.t - floor(point.t)) > Float(0.5f));
  Vec3<Float> value = select(even, at(textures->color1), at(textures->color0));
  const Mask bitmap = at(textures->kind) == UInt(static_cast<uint32_t>(TextureKind::bitmap));
  if (none(bitmap)) return value;

  const TexelCell cell = texelCell(textures, at, bitmap, point);
  const Float leftPart = Float(1) - cell.x;
  const Vec3<Float> upper = texel(texels, cell.topLeft) * leftPart + texel(texels, cell.topRight) * cell.x;
  const Vec3<Float> lower = texel(texels, cell.bottomLeft) * leftPart + texel(texels, cell.bottomRight) * cell.x;
  return select(bitmap, upper * (Float(1) - cell.y) + lower * cell.y, value);
}

// Derivatives by u and v of the first channel of the textures with the given ids: those of the bilinear patch at
// (u, v), as Mitsuba's eval_1_grad. 0 where a texture has steps only: of checkerboards, and of bitmaps whose nearest
// texel is taken.
struct TextureSlopes {
  Float u, v;
};
WAVECREST_NOINLINE inline TextureSlopes textureSlopes(const TextureRecord* textures, const float* texels, UInt id,
                                                      Float u, Float v) {
  const RecordLanes<TextureRecord> at(textures, id);
  const Mask bitmap = at(textures->kind) == UInt(static_cast<uint32_t>(TextureKind::bitmap));
  const Mask smooth = andNot(bitmap, at(textures->nearest) == UInt(1u));
  if (none(smooth)) return {Float(0), Float(0)};
  const TexelCell cell = texelCell(textures, at, bitmap, texturePoint(textures, at, u, v));
  const Float topLeft = gather(texels, cell.topLeft), topRight = gather(texels, cell.topRight);
  const Float bottomLeft = gather(texels, cell.bottomLeft), bottomRight = gather(texels, cell.bottomRight);
  // By s and t, which are a width and a height of texels long.
  const Float acrossTexels = mulAdd(cell.y, (bottomRight - bottomLeft) - (topRight - topLeft), topRight - topLeft);
  const Float downTexels = mulAdd(cell.x, (bottomRight - topRight) - (bottomLeft - topLeft), bottomLeft - topLeft);
  const Float byS = zeroUnless(smooth, acrossTexels * toFloat(max(at(textures->width), UInt(1u))));
  const Float byT = zeroUnless(smooth, downTexels * toFloat(max(at(textures->height), UInt(1u))));
  return {mulAdd(byS, at(textures->toUv[0]), byT * at(textures->toUv[3])),
          mulAdd(byS, at(textures->toUv[1]), byT * at(textures->toUv[4]))};
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
