#include "engine/film/splat_films.h"

#include <algorithm>
#include <bit>
#include <new>

#include "engine/state/state_stream.h"

namespace wavecrest {
namespace {

// Regions of a shared film: many more than the workers that add at the same time.
constexpr size_t kRegions = 128;

// Zeros; large ones are pages of the system that take no memory until they are written.
uint64_t* zeros(size_t count) {
  auto* const words = static_cast<uint64_t*>(std::calloc(std::max<size_t>(count, 1), sizeof(uint64_t)));
  if (words == nullptr) throw std::bad_alloc();
  return words;
}

// Returns the logarithm of the number of pixels in a region. A shared film has at most kRegions regions.
uint32_t bitsOfRegions(size_t pixels, size_t threads) {
  if (threads <= kSplatFilms) return 63;  // all pixels
  return static_cast<uint32_t>(std::bit_width((std::max<size_t>(pixels, 1) - 1) / kRegions));
}

size_t regionsOf(size_t pixels, uint32_t regionBits) { return ((std::max<size_t>(pixels, 1) - 1) >> regionBits) + 1; }

}  // namespace

SplatFilm::SplatFilm(size_t pixels, size_t regions, double scale)
    : low_(zeros(3 * pixels)),
      high_(zeros(3 * pixels)),
      locks_(new std::mutex[regions]),
      sums_{low_.get(), high_.get(), scale} {}

SplatFilms::SplatFilms(size_t pixels, size_t threads, double scale)
    : pixels_(pixels),
      scale_(scale),
      regionBits_(bitsOfRegions(pixels, threads)),
      regions_(regionsOf(pixels, regionBits_)) {
  for (size_t i = 0; i < std::min(threads, kSplatFilms); ++i) {
    films_.push_back(std::make_unique<SplatFilm>(pixels, regions_, scale));
  }
}

void SplatFilms::add(uint32_t pixel, const double (&rgb)[3]) {
  for (size_t c = 0; c < 3; ++c) addToSplatSum(films_.front()->sums(), 3 * size_t{pixel} + c, rgb[c]);
}

__int128 SplatFilms::sum(size_t channel) const {
  __int128 sum = 0;
  for (const auto& film : films_) sum += splatSum(film->sums(), channel);
  return sum;
}

void SplatFilms::save(StateWriter& out) const {
  out.value(scale_);
  // Write the sums over all films, which do not depend on the number of films.
  for (size_t channel = 0; channel < 3 * pixels_; ++channel) out.value(sum(channel));
}

void SplatFilms::setFirst(size_t channel, __int128 sum) {
  const SplatSums& sums = films_.front()->sums();
  sums.low[channel] = static_cast<uint64_t>(sum);
  if (const auto high = static_cast<uint64_t>(sum >> 64); high != sums.high[channel]) sums.high[channel] = high;
}

// The first film takes the sums of all.
void SplatFilms::restore(StateReader& in) {
  if (in.value<double>() != scale_) throw StateError("its splats are in other units");
  for (size_t channel = 0; channel < 3 * pixels_; ++channel) setFirst(channel, in.value<__int128>());
}

// Sums are within kSplatLimit and a splat, so those of two films do not overflow; the total is kept within it as well.
void SplatFilms::addToFirst(size_t channel, __int128 sum) {
  constexpr auto kLimit = static_cast<__int128>(kSplatLimit);
  setFirst(channel, std::clamp(splatSum(films_.front()->sums(), channel) + sum, -kLimit, kLimit));
}

void SplatFilms::add(const SplatFilms& other) {
  for (size_t channel = 0; channel < 3 * pixels_; ++channel) addToFirst(channel, other.sum(channel));
}

void SplatFilms::addSaved(StateReader& in) {
  if (in.value<double>() != scale_) throw StateError("its splats are in other units");
  for (size_t channel = 0; channel < 3 * pixels_; ++channel) addToFirst(channel, in.value<__int128>());
}

size_t SplatFilms::bytesFor(size_t pixels, size_t threads) {
  // Each pixel has low and high halves of three channels.
  return std::min(threads, kSplatFilms) * pixels * 6 * sizeof(uint64_t);
}

template <class S>
SplatWriter<S>::SplatWriter(SplatFilms& films, AddSplats<S> addSplats, size_t capacity)
    : films_(films), film_(films.assign()), addSplats_(addSplats) {
  if (films.regions() == 1) return;
  arena_ = Arena(sorted_.bytes(capacity));
  sorted_.bind(arena_, capacity);
  begins_.resize(films.regions() + 1);
}

template <class S>
size_t SplatWriter<S>::bytesFor(size_t pixels, size_t threads, size_t capacity) {
  return regionsOf(pixels, bitsOfRegions(pixels, threads)) == 1 ? 0 : Splats<S>().bytes(capacity);
}

// Counting sort by region.
template <class S>
void SplatWriter<S>::sort(const Splats<S>& splats) {
  const uint32_t bits = films_.regionBits();
  std::fill(begins_.begin(), begins_.end(), 0);
  // Count the splats of region r at begins_[r + 1].
  for (size_t i = 0; i < splats.size; ++i) ++begins_[(splats.pixel[i] >> bits) + 1];
  // The counts of all regions before r add up to the begin of r.
  for (size_t region = 1; region < begins_.size(); ++region) begins_[region] += begins_[region - 1];
  // Move each splat to its region.
  for (size_t i = 0; i < splats.size; ++i) {
    const uint32_t out = begins_[splats.pixel[i] >> bits]++;
    sorted_.red[out] = splats.red[i];
    sorted_.green[out] = splats.green[i];
    sorted_.blue[out] = splats.blue[i];
    sorted_.pixel[out] = splats.pixel[i];
  }
  // Every begin has moved to the next one's.
  std::copy_backward(begins_.begin(), begins_.end() - 1, begins_.end());
  begins_[0] = 0;
}

template <class S>
void SplatWriter<S>::drain(Splats<S>& splats, StageCounters& counters) {
  if (splats.size == 0) return;
  if (films_.regions() == 1) {
    const std::lock_guard<std::mutex> lock(film_.lockOf(0));
    addSplats_(splats, 0, splats.size, film_.sums(), counters);
    splats.size = 0;
    return;
  }
  // Add to a shared film region by region, each under its own lock.
  sort(splats);
  for (size_t region = 0; region + 1 < begins_.size(); ++region) {
    if (begins_[region] == begins_[region + 1]) continue;
    const std::lock_guard<std::mutex> lock(film_.lockOf(region));
    addSplats_(sorted_, begins_[region], begins_[region + 1], film_.sums(), counters);
  }
  splats.size = 0;
}

template class SplatWriter<float>;
template class SplatWriter<double>;

}  // namespace wavecrest
