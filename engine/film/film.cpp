#include "engine/film/film.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include "engine/state/state_stream.h"

namespace wavecrest {
namespace {

std::vector<PendingSplat> pendingFrom(StateReader& in, size_t pixels) {
  std::vector<PendingSplat> pending = in.list<PendingSplat>();
  if (std::any_of(pending.begin(), pending.end(), [&](const auto& splat) { return splat.pixel >= pixels; })) {
    throw StateError("its splats are beyond the film");
  }
  return pending;
}

}  // namespace

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
  const double splatFactor = splatCount_ == 0 ? 0 : splatUnit_ / static_cast<double>(splatCount_);
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
      // Add the splats of all films and those that chains owe. The factor turns the sum into radiance.
      double splats = splats_ ? splats_->total(pixel + c) / splats_->scale() : 0;
      if (!pending.empty()) splats += pending[pixel + c];
      value += splats * splatFactor;
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

Film::Kind Film::kind() const {
  return {.x0 = area_.x0,
          .y0 = area_.y0,
          .width = area_.width,
          .height = area_.height,
          .spreads = spread_ ? 1u : 0u,
          .filter = spread_ ? static_cast<uint32_t>(spread_->filter()) : 0u,
          .filterScale = spread_ ? spread_->filterScale() : 0,
          .splatScale = splats_ ? splats_->scale() : 0};
}

void Film::save(StateWriter& out) const {
  static_assert(sizeof(Kind) == 6 * sizeof(uint32_t) + 2 * sizeof(double), "padding would be written");
  static_assert(sizeof(PendingSplat) == 4 * sizeof(double), "padding would be written");
  // The order is kind, sums of tiles or of pixels, numbers of samples, splats. restoreSums() reads the same order.
  out.value(kind());
  if (spread_) {
    spread_->save(out);
  } else {
    out.items(sums_.data(), sums_.size());
  }
  out.items(samples_.data(), samples_.size());
  if (splats_) splats_->save(out);
  out.value(splatUnit_);
  out.value(splatCount_);
  out.list(pending_);
}

void Film::restore(StateReader& in) {
  if (in.value<Kind>() != kind()) throw StateError("its film is of another kind");
  restoreSums(in);
}

std::unique_ptr<Film> Film::fromState(StateReader& in) {
  const auto kind = in.value<Kind>();
  // The film is not larger than what follows of the state, so that a wrong size takes no memory.
  if (uint64_t{kind.width} * kind.height > in.left() / sizeof(uint64_t)) throw StateError("its state ends too early");
  auto film = std::make_unique<Film>(FilmArea::make(kind.x0, kind.y0, kind.width, kind.height));
  if (kind.spreads != 0) {
    CameraView camera{};
    camera.filter = static_cast<FilterKind>(kind.filter);
    camera.filterScale = kind.filterScale;
    if (!canSpread(camera)) throw StateError("its filter cannot be spread");
    film->spreadBy(camera);
  }
  if (kind.splatScale > 0) film->makeSplats(1, kind.splatScale);
  if (film->kind() != kind) throw StateError("its film is of no kind");
  film->restoreSums(in);
  return film;
}

void Film::restoreSums(StateReader& in) {
  if (spread_) {
    spread_->restore(in);
  } else {
    in.items(sums_.data(), sums_.size());
  }
  in.items(samples_.data(), samples_.size());
  if (splats_) splats_->restore(in);
  splatUnit_ = in.value<double>();
  splatCount_ = in.value<uint64_t>();
  pending_ = pendingFrom(in, area_.pixels.size());
}

void Film::add(const Film& other) {
  if (other.kind() != kind()) throw StateError("its film is of another kind");
  requireUnit(other.splatUnit_);
  if (spread_) {
    spread_->add(*other.spread_);
  } else {
    std::transform(sums_.begin(), sums_.end(), other.sums_.begin(), sums_.begin(), std::plus<>());
  }
  std::transform(samples_.begin(), samples_.end(), other.samples_.begin(), samples_.begin(), std::plus<>());
  if (splats_) splats_->add(*other.splats_);
  addUnits(other.splatUnit_, other.splatCount_, other.pending_);
}

void Film::addSaved(StateReader& in) {
  if (in.value<Kind>() != kind()) throw StateError("its film is of another kind");
  if (spread_) {
    spread_->addSaved(in);
  } else {
    in.addTo(std::span(sums_));
  }
  in.addTo(std::span(samples_));
  if (splats_) splats_->addSaved(in);
  const auto unit = in.value<double>();
  const auto count = in.value<uint64_t>();
  requireUnit(unit);
  addUnits(unit, count, pendingFrom(in, area_.pixels.size()));
}

// Without light there is no unit. All films that found some have the same.
void Film::requireUnit(double splatUnit) const {
  if (splatUnit_ != splatUnit && splatUnit_ != 0 && splatUnit != 0) throw StateError("its splats are scaled otherwise");
}

void Film::addUnits(double splatUnit, uint64_t splatCount, const std::vector<PendingSplat>& pending) {
  splatUnit_ = std::max(splatUnit_, splatUnit);
  splatCount_ += splatCount;
  // In the order of chains, as one render has them.
  pending_.insert(pending_.end(), pending.begin(), pending.end());
  std::stable_sort(pending_.begin(), pending_.end(),
                   [](const PendingSplat& a, const PendingSplat& b) { return a.chain < b.chain; });
}

}  // namespace wavecrest
