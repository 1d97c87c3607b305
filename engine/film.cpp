#include "engine/film.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "engine/session_state.h"

namespace wavecrest {
namespace {

constexpr uint32_t kTile = 16;  // pixels; a square tile of camera rays fills 16 blocks of 16 lanes

// Interleaves the bits of x and y below kTile: neighbours in order are neighbours in the image.
uint32_t mortonInTile(uint32_t x, uint32_t y) {
  uint32_t code = 0;
  for (uint32_t bit = 0; bit < 4; ++bit) {
    code |= ((x >> bit) & 1u) << (2 * bit) | ((y >> bit) & 1u) << (2 * bit + 1);
  }
  return code;
}

}  // namespace

FilmArea FilmArea::make(uint32_t x0, uint32_t y0, uint32_t width, uint32_t height) {
  FilmArea area{.width = width, .height = height, .x0 = x0, .y0 = y0, .pixels = {}};
  struct Key {
    uint64_t order;
    uint32_t pixel;
  };
  std::vector<Key> keys;
  keys.reserve(size_t{width} * height);
  const uint32_t tilesAcross = (width + kTile - 1) / kTile;
  for (uint32_t y = 0; y < height; ++y) {
    for (uint32_t x = 0; x < width; ++x) {
      const uint64_t tile = uint64_t{y / kTile} * tilesAcross + x / kTile;
      keys.push_back({tile * kTile * kTile + mortonInTile(x % kTile, y % kTile), (y0 + y) << 16 | (x0 + x)});
    }
  }
  std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) { return a.order < b.order; });
  area.pixels.reserve(keys.size() + kColumnPadding);
  for (const Key& key : keys) area.pixels.push_back(key.pixel);
  return area;
}

Film::Film(FilmArea area) : area_(std::move(area)), sums_(3 * area_.pixels.size()), samples_(area_.pixels.size()) {}

template <class S>
uint64_t Film::add(const Wave<S>& wave) {
  uint64_t nonFinite = 0;
  for (size_t i = 0; i < wave.pathCount; ++i) {
    const double r = wave.radiance.red[i], g = wave.radiance.green[i], b = wave.radiance.blue[i];
    const size_t pixel = wave.firstPath + (i >> wave.iterationBits);
    ++samples_[pixel];
    if (!std::isfinite(r + g + b)) {
      ++nonFinite;
      continue;
    }
    sums_[3 * pixel] += r;
    sums_[3 * pixel + 1] += g;
    sums_[3 * pixel + 2] += b;
  }
  return nonFinite;
}
template uint64_t Film::add(const Wave<float>&);
template uint64_t Film::add(const Wave<double>&);

std::vector<float> Film::resolve() const {
  std::vector<float> image(3 * size_t{area_.width} * area_.height, 0.0f);
  std::vector<double> pending;
  if (!pending_.empty()) pending.resize(image.size());
  for (const PendingSplat& splat : pending_) {
    for (size_t c = 0; c < 3; ++c) pending[3 * size_t{splat.pixel} + c] += splat.rgb[c];
  }
  for (size_t i = 0; i < area_.pixels.size(); ++i) {
    const uint32_t x = (area_.pixels[i] & 0xffffu) - area_.x0, y = (area_.pixels[i] >> 16) - area_.y0;
    const size_t pixel = 3 * (size_t{y} * area_.width + x);
    for (size_t c = 0; c < 3; ++c) {
      double value = samples_[i] == 0 ? 0 : sums_[3 * i + c] / static_cast<double>(samples_[i]);
      double splats = splats_ ? splats_->total(pixel + c) / splats_->scale() : 0;
      if (!pending.empty()) splats += pending[pixel + c];
      value += splats * splatFactor_;
      image[pixel + c] = static_cast<float>(value);
    }
  }
  return image;
}

uint64_t Film::minSamples() const { return samples_.empty() ? 0 : *std::min_element(samples_.begin(), samples_.end()); }
uint64_t Film::maxSamples() const { return samples_.empty() ? 0 : *std::max_element(samples_.begin(), samples_.end()); }
uint64_t Film::allSamples() const { return std::accumulate(samples_.begin(), samples_.end(), uint64_t{0}); }

std::vector<PixelRun> Film::runsBelow(uint64_t samples, size_t most) const {
  std::vector<PixelRun> runs;
  for (size_t begin = 0; begin < samples_.size();) {
    size_t end = begin + 1;
    while (end < samples_.size() && end - begin < most && samples_[end] == samples_[begin]) ++end;
    if (samples_[begin] < samples) runs.push_back({begin, end - begin, samples_[begin]});
    begin = end;
  }
  return runs;
}

void Film::save(StateWriter& out) const {
  out.value(uint64_t{area_.pixels.size()});
  out.items(sums_.data(), sums_.size());
  out.items(samples_.data(), samples_.size());
  if (splats_) splats_->save(out);
}

void Film::restore(StateReader& in) {
  in.expect(area_.pixels.size(), "pixels");
  in.items(sums_.data(), sums_.size());
  in.items(samples_.data(), samples_.size());
  if (splats_) splats_->restore(in);
}

}  // namespace wavecrest
