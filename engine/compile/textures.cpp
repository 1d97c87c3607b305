#include "engine/compile/textures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <string>

#include "engine/compile/pick_table.h"
#include "engine/scene/scene_error.h"
#include "engine/scene/vector_math.h"

namespace wavecrest {
namespace {

size_t pixelsOf(const Bitmap& bitmap) { return size_t{bitmap.width} * bitmap.height; }

// Appends the texels as RGB times `scale`; a single channel is repeated.
void appendRgb(const Bitmap& bitmap, double scale, std::vector<float>& out) {
  const size_t pixels = pixelsOf(bitmap);
  for (size_t i = 0; i < pixels; ++i) {
    for (size_t c = 0; c < 3; ++c) {
      const float value = bitmap.pixels[i * bitmap.channels + (bitmap.channels == 3 ? c : 0)];
      out.push_back(static_cast<float>(value * scale));
    }
  }
}

double luminanceAt(const std::vector<float>& texels, uint32_t width, uint32_t column, uint32_t row) {
  const float* rgb = &texels[3 * (size_t{row} * width + column)];
  return luminance({rgb[0], rgb[1], rgb[2]});
}

// SceneError if there are more floats of bitmaps than kernels can index: they count in 32 bits with a sign.
void requireIndexed(size_t floats, const SourceLocation& where) {
  constexpr size_t kMost = std::numeric_limits<int32_t>::max();
  if (floats <= kMost) return;
  throw SceneError(where, "bitmaps of " + std::to_string(floats / 3) + " pixels together; expected at most " +
                              std::to_string(kMost / 3));
}

// The floats of all bitmaps, one that several textures share counted once.
size_t countTexels(const Scene& scene) {
  std::set<const Bitmap*> bitmaps;
  size_t floats = 0;
  for (const Texture& texture : scene.textures) {
    const auto* bitmap = std::get_if<BitmapTexture>(&texture.kind);
    if (bitmap != nullptr && bitmaps.insert(bitmap->bitmap.get()).second) floats += 3 * pixelsOf(*bitmap->bitmap);
  }
  requireIndexed(floats, {scene.name});
  return floats;
}

}  // namespace

Textures compileTextures(const Scene& scene) {
  Textures out;
  out.texels.reserve(countTexels(scene));
  // Where the texels of each bitmap begin in out.texels.
  std::map<const Bitmap*, uint32_t> offsets;
  for (const Texture& texture : scene.textures) {
    TextureRecord& record = out.records.emplace_back();
    // The columns of u, v and 1 of the matrix.
    for (size_t row = 0; row < 2; ++row) {
      record.toUv[3 * row] = static_cast<float>(texture.toUv[row][0]);
      record.toUv[3 * row + 1] = static_cast<float>(texture.toUv[row][1]);
      record.toUv[3 * row + 2] = static_cast<float>(texture.toUv[row][3]);
    }
    // A checkerboard has no texels.
    if (const auto* checkerboard = std::get_if<CheckerboardTexture>(&texture.kind)) {
      record.kind = static_cast<uint32_t>(TextureKind::checkerboard);
      assign(record.color0, checkerboard->color0);
      assign(record.color1, checkerboard->color1);
      continue;
    }
    const auto& bitmap = std::get<BitmapTexture>(texture.kind);
    record.kind = static_cast<uint32_t>(TextureKind::bitmap);
    record.width = bitmap.bitmap->width;
    record.height = bitmap.bitmap->height;
    record.nearest = bitmap.filter == Filter::nearest ? 1 : 0;
    record.wrap = static_cast<uint32_t>(bitmap.wrap == Wrap::repeat   ? WrapMode::repeat
                                        : bitmap.wrap == Wrap::mirror ? WrapMode::mirror
                                                                      : WrapMode::clamp);
    // The texels, unless a texture before has stored the same bitmap.
    const auto [place, added] = offsets.try_emplace(bitmap.bitmap.get(), static_cast<uint32_t>(out.texels.size()));
    if (added) appendRgb(*bitmap.bitmap, 1, out.texels);
    record.offset = place->second;
  }
  return out;
}

Environment compileEnvironment(const EnvmapEmitter& emitter, const SourceLocation& where) {
  requireIndexed(3 * pixelsOf(*emitter.bitmap), where);
  Environment out;
  const uint32_t width = emitter.bitmap->width, height = emitter.bitmap->height;
  out.texels.reserve(3 * pixelsOf(*emitter.bitmap));
  appendRgb(*emitter.bitmap, emitter.scale, out.texels);

  // Weight of a texel: mean luminance of the 3 x 3 texels around, times sin(theta) for its solid angle.
  std::vector<double> weights(size_t{width} * height);
  double total = 0, solidAngle = 0;
  for (uint32_t row = 0; row < height; ++row) {
    const double sinTheta = std::sin(std::numbers::pi * (row + 0.5) / height);
    for (uint32_t column = 0; column < width; ++column) {
      // Interpolation reaches the neighbours on every side.
      double around = 0;
      for (const uint32_t y : {row == 0 ? 0 : row - 1, row, std::min(row + 1, height - 1)}) {
        for (const uint32_t x : {(column + width - 1) % width, column, (column + 1) % width}) {
          around += luminanceAt(out.texels, width, x, y) / 9;
        }
      }
      weights[size_t{row} * width + column] = around * sinTheta;
      total += around * sinTheta;
      out.meanLuminance += luminanceAt(out.texels, width, column, row) * sinTheta;
      solidAngle += sinTheta;
    }
  }
  out.meanLuminance /= solidAngle;
  if (!(total > 0)) std::fill(weights.begin(), weights.end(), 1.0);  // black: sampled evenly, to no effect
  // The alias table and the probabilities. Kernels take columns and rows, so the table names those.
  out.table = makeAliasTable(weights);
  const std::vector<double> columns = entryShares(width), rows = entryShares(height);
  std::vector<double> chosen;
  for (const double row : rows) {
    for (const double column : columns) chosen.push_back(row * column);
  }
  for (const double share : sharesOf(out.table, chosen)) out.probability.push_back(static_cast<float>(share));
  for (AliasEntry& entry : out.table) entry.other = entry.other % width | entry.other / width << kTexelBits;

  // The view, and the rotation to the map's frame.
  out.view = {.texels = out.texels.data(),
              .probability = out.probability.data(),
              .table = out.table.data(),
              .width = width,
              .height = height};
  // Rows of the inverse of a rotation: its columns, normalised in case the transform scales.
  for (size_t column = 0; column < 3; ++column) {
    const Double3 axis =
        normalized({emitter.toWorld[0][column], emitter.toWorld[1][column], emitter.toWorld[2][column]});
    for (size_t i = 0; i < 3; ++i) out.view.toLocal[column][i] = static_cast<float>(axis[i]);
  }
  return out;
}

}  // namespace wavecrest
