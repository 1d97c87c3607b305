#include "bench/campaign/shrunk_reference.h"

#include <fmt/format.h>

#include "engine/load/scene_hash.h"
#include "engine/scene/hash_text.h"

namespace wavecrest {
namespace {

// How many pixels of the larger image a pixel of the film covers in each direction. Throws ShrinkError.
uint32_t shrinkFactor(const Image& larger, const FilmSettings& film) {
  const uint32_t factor = larger.width / film.width;
  if (factor >= 2 && larger.width == factor * film.width && larger.height == factor * film.height) return factor;
  throw ShrinkError(fmt::format("is {}x{} pixels; expected a whole multiple of {}x{}, the same in both directions",
                                larger.width, larger.height, film.width, film.height));
}

// Throws ShrinkError where the pixels of the film are not means of those of the larger one.
void requireBoxFilter(const FilmSettings& film) {
  if (film.filter != ReconstructionFilter::box || film.filterRadius != 0.5) {
    throw ShrinkError("cannot be averaged: the scene's filter reaches over pixels; expected a box filter");
  }
  if (film.isCropped()) throw ShrinkError("cannot be averaged: the film is cropped; expected a whole film");
}

// The hash of the scene with a film of that size.
uint64_t hashAtSize(Scene scene, uint32_t width, uint32_t height) {
  scene.film.width = width;
  scene.film.height = height;
  return hashScene(scene);
}

// The means of blocks of factor x factor pixels.
Image blockMeans(const Image& larger, uint32_t factor) {
  Image means{
      .width = larger.width / factor, .height = larger.height / factor, .channels = larger.channels, .pixels = {}};
  means.pixels.resize(size_t{means.width} * means.height * means.channels);
  for (uint32_t y = 0; y < means.height; ++y) {
    for (uint32_t x = 0; x < means.width; ++x) {
      for (uint32_t c = 0; c < means.channels; ++c) {
        double sum = 0;
        for (uint32_t row = factor * y; row < factor * (y + 1); ++row) {
          const size_t first = (size_t{row} * larger.width + size_t{factor} * x) * larger.channels + c;
          for (uint32_t i = 0; i < factor; ++i) sum += larger.pixels[first + size_t{i} * larger.channels];
        }
        means.pixels[(size_t{y} * means.width + x) * means.channels + c] =
            static_cast<float>(sum / (1.0 * factor * factor));
      }
    }
  }
  return means;
}

}  // namespace

Reference shrunkReference(const Reference& larger, const Scene& scene) {
  if (const std::string wrong = whyNoReference(larger); !wrong.empty()) {
    throw ShrinkError(wrong + "; expected a reference of a larger film");
  }
  if (larger.info.isCompact()) throw ShrinkError("is compact; expected a whole reference");
  if (larger.info.isBiased()) throw ShrinkError("is by a method that merges; expected one that does not");
  const uint32_t factor = shrinkFactor(larger.mean, scene.film);
  requireBoxFilter(scene.film);
  const std::string hash = hashText(hashAtSize(scene, larger.mean.width, larger.mean.height));
  if (larger.info.sceneHash != hash) {
    throw ShrinkError(
        fmt::format("is of scene_hash {}; expected {} of this {}", larger.info.sceneHash, hash, scene.name));
  }

  Reference shrunk{.mean = blockMeans(larger.mean, factor),
                   .difference = blockMeans(*larger.difference, factor),
                   .info = larger.info,
                   .noiseFloors = {}};
  shrunk.info.sceneHash = hashText(scene.hash);
  shrunk.info.iterations *= uint64_t{factor} * factor;
  shrunk.info.relativeError = relativeError(shrunk.mean, *shrunk.difference);
  measureNoiseFloors(shrunk);
  return shrunk;
}

}  // namespace wavecrest
