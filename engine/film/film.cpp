#include "engine/film/film.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "engine/state/state_stream.h"

namespace wavecrest {

Film::Film(FilmArea area) : area_(std::move(area)), sums_(3 * area_.pixels.size()), samples_(area_.pixels.size()) {}

void Film::spreadBy(const CameraView& camera) {
  // Sums of tiles take the place of sums of pixels.
  spread_.emplace(camera, area_);
  sums_ = std::vector<double>();  // gives the memory back, which = {} does not
}

template <class S>
uint64_t Film::add(const Wave<S>& wave) {
  uint64_t nonFinite = 0;
  for (size_t i = 0; i < wave.pathCount; ++i) {
    const double r = wave.radiance.red[i], g = wave.radiance.green[i], b = wave.radiance.blue[i];
    // The lanes of a pixel's iterations lie side by side.
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

template <class S>
uint64_t Film::spread(const Wave<S>& wave, std::span<const FilterPlace> places, SpreadSamples<S> spreadSamples) {
  // Every pixel gets one sample of each iteration in the wave.
  const size_t pixels = wave.pathCount >> wave.iterationBits;
  for (size_t i = 0; i < pixels; ++i) samples_[wave.firstPath + i] += uint64_t{1} << wave.iterationBits;
  return spread_->add(wave, places, spreadSamples);
}
template uint64_t Film::spread(const Wave<float>&, std::span<const FilterPlace>, SpreadSamples<float>);
template uint64_t Film::spread(const Wave<double>&, std::span<const FilterPlace>, SpreadSamples<double>);

std::vector<float> Film::resolve() const {
  std::vector<float> image(3 * size_t{area_.width} * area_.height, 0.0f);
  // Spread samples and pending splats become images in double, row by row.
  std::vector<double> spread;
  if (spread_) spread = spread_->resolve(samples_);
  std::vector<double> pending;
  if (!pending_.empty()) pending.resize(image.size());
  for (const PendingSplat& splat : pending_) {
    for (size_t c = 0; c < 3; ++c) pending[3 * size_t{splat.pixel} + c] += splat.rgb[c];
  }
  // Pixels are in wave order, the image is row by row.
  for (size_t i = 0; i < area_.pixels.size(); ++i) {
    // x and y count from the corner of the rendered rectangle.
    const uint32_t x = (area_.pixels[i] & 0xffffu) - area_.x0, y = (area_.pixels[i] >> 16) - area_.y0;
    const size_t pixel = 3 * (size_t{y} * area_.width + x);
    for (size_t c = 0; c < 3; ++c) {
      // Take the mean of the pixel's samples.
      double value = 0;
      if (spread_) {
        value = spread[pixel + c];
      } else if (samples_[i] != 0) {
        value = sums_[3 * i + c] / static_cast<double>(samples_[i]);
      }
      // Add the splats of all films and those that chains owe. splatFactor_ turns the sum into radiance.
      double splats = splats_ ? splats_->total(pixel + c) / splats_->scale() : 0;
      if (!pending.empty()) splats += pending[pixel + c];
      value += splats * splatFactor_;
      image[pixel + c] = static_cast<float>(value);
    }
  }
  return image;
}

size_t Film::imageBytesFor(size_t pixels, bool spreads, bool pending) {
  // The image is in float. While it is made there are up to two more images in double.
  return 3 * pixels * (sizeof(float) + sizeof(double) * (size_t{spreads} + size_t{pending}));
}

uint64_t Film::minSamples() const { return samples_.empty() ? 0 : *std::min_element(samples_.begin(), samples_.end()); }
uint64_t Film::maxSamples() const { return samples_.empty() ? 0 : *std::max_element(samples_.begin(), samples_.end()); }
uint64_t Film::allSamples() const { return std::accumulate(samples_.begin(), samples_.end(), uint64_t{0}); }

std::vector<PixelRun> Film::runsBelow(uint64_t samples, size_t most) const {
  std::vector<PixelRun> runs;
  // A film that spreads has runs of whole tiles. All pixels of a tile have the same number of samples.
  if (spread_) {
    for (size_t tile = 0; tile + 1 < area_.tiles.size(); ++tile) {
      const size_t begin = area_.tiles[tile], count = area_.tiles[tile + 1] - begin;
      if (samples_[begin] >= samples) continue;
      if (!runs.empty() && runs.back().first + runs.back().count == begin && runs.back().samples == samples_[begin] &&
          runs.back().count + count <= most) {
        runs.back().count += count;
      } else {
        runs.push_back({begin, count, samples_[begin]});
      }
    }
    return runs;
  }
  // Other films have runs of any neighbours in wave order.
  for (size_t begin = 0; begin < samples_.size();) {
    size_t end = begin + 1;
    while (end < samples_.size() && end - begin < most && samples_[end] == samples_[begin]) ++end;
    if (samples_[begin] < samples) runs.push_back({begin, end - begin, samples_[begin]});
    begin = end;
  }
  return runs;
}

size_t Film::bytes() const {
  return area_.bytes() + sums_.size() * sizeof(double) + samples_.size() * sizeof(uint64_t) +
         (spread_ ? spread_->bytes() : 0);
}

void Film::save(StateWriter& out) const {
  // The order is sums of tiles or of pixels, numbers of samples, splats. restore() reads the same order.
  out.value(uint64_t{area_.pixels.size()});
  if (spread_) {
    spread_->save(out);
  } else {
    out.items(sums_.data(), sums_.size());
  }
  out.items(samples_.data(), samples_.size());
  if (splats_) splats_->save(out);
}

void Film::restore(StateReader& in) {
  in.expect(area_.pixels.size(), "pixels");
  if (spread_) {
    spread_->restore(in);
  } else {
    in.items(sums_.data(), sums_.size());
  }
  in.items(samples_.data(), samples_.size());
  if (splats_) splats_->restore(in);
}

}  // namespace wavecrest
