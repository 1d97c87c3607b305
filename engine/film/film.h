// The film: what all iterations have added up to, pixel by pixel.
//
// Sums of samples are in double, so a million iterations keep the precision of float samples. An image is the same bit
// for bit on any number of threads: a pixel's samples are added in the order of iterations, and splats are summed as
// integers, whose total does not depend on the order.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "engine/film/film_area.h"
#include "engine/film/splat_films.h"
#include "engine/film/spread_sums.h"
#include "kernels/columns/wave.h"

namespace wavecrest {

// A splat of one pixel of the rendered rectangle, counted row by row.
struct PendingSplat {
  uint32_t pixel;
  uint32_t chain;  // which owes it
  double rgb[3];
};

// Pixels [first, first + count) in wave order, which have the same number of samples.
struct PixelRun {
  size_t first, count;
  uint64_t samples;
};

class Film {
 public:
  explicit Film(FilmArea area);

  // Adds one sample for each path of the wave, a pixel's in the order of their iterations. Samples that are not finite
  // count as black; returns how many there were. Waves of disjoint pixels may be added at the same time.
  template <class S>
  uint64_t add(const Wave<S>& wave);

  // From now on samples are spread over the filter's footprint: spread() takes the place of add(). For an empty film.
  void spreadBy(const CameraView& camera);
  bool spreads() const { return spread_.has_value(); }
  // Adds the samples of a wave of whole tiles, a tile's in the order of their iterations; otherwise as add().
  template <class S>
  uint64_t spread(const Wave<S>& wave, std::span<const FilterPlace> places, SpreadSamples<S> spreadSamples);

  // Makes room for splats; see SplatFilms.
  void makeSplats(size_t threads, double scale) { splats_.emplace(area_.pixels.size(), threads, scale); }
  bool hasSplats() const { return splats_.has_value(); }
  SplatFilms& splats() { return *splats_; }
  const SplatFilms& splats() const { return *splats_; }
  // The sum of all splats times unit / count is radiance. count: of the light paths or mutations that made them.
  void weighSplats(double unit, uint64_t count) {
    splatUnit_ = unit;
    splatCount_ = count;
  }
  uint64_t splatCount() const { return splatCount_; }
  // Splats that belong to the image of now but not to the sums: those that Markov chains owe, in the order of chains.
  void setPending(std::vector<PendingSplat> pending) { pending_ = std::move(pending); }

  // The image, row by row from the top, RGB: the mean of each pixel's samples (black where there are none) plus the
  // splats. No wave may be under way.
  std::vector<float> resolve() const;
  // What resolve() takes: the image, and where samples are spread or chains owe splats, an image in double of each.
  size_t imageBytes() const { return imageBytesFor(area_.pixels.size(), spreads(), !pending_.empty()); }
  static size_t imageBytesFor(size_t pixels, bool spreads, bool pending);

  const FilmArea& area() const { return area_; }
  // Samples of the pixels: the fewest and the most of one, and of all together.
  uint64_t minSamples() const;
  uint64_t maxSamples() const;
  uint64_t allSamples() const;
  // The pixels with fewer samples than `samples`, in runs of at most `most` pixels; of whole tiles where the film
  // spreads, at least one in each.
  std::vector<PixelRun> runsBelow(uint64_t samples, size_t most) const;

  // Of the list of pixels, sums and numbers of samples, without splats.
  size_t bytes() const;

  // Everything that resolve() takes, for checkpoints; and back into a film of the same kind without any samples.
  void save(StateWriter& out) const;
  void restore(StateReader& in);
  // A film of the kind that the state says, with what it holds: for whoever has no scene.
  static std::unique_ptr<Film> fromState(StateReader& in);

  // Adds the samples and splats of another film of the same render. Splats are summed as integers: their total does not
  // depend on the order of films. Samples are summed as doubles: their last bits do. Throws StateError
  // where the other film is of another kind.
  void add(const Film& other);
  // The same of a film that was saved.
  void addSaved(StateReader& in);

 private:
  // What films that can be added have in common, as it stands at the head of a state. Without padding.
  struct Kind {
    uint32_t x0, y0, width, height;
    uint32_t spreads;    // 1 or 0
    uint32_t filter;     // FilterKind, 0 where samples are not spread
    double filterScale;  // 0 where samples are not spread
    double splatScale;   // 0 without splats
    bool operator==(const Kind&) const = default;
  };
  Kind kind() const;
  void restoreSums(StateReader& in);
  void addUnits(double splatUnit, uint64_t splatCount, const std::vector<PendingSplat>& pending);
  void requireUnit(double splatUnit) const;

  FilmArea area_;
  std::vector<double> sums_;          // RGB, in wave order
  std::vector<uint64_t> samples_;     // in wave order
  std::optional<SpreadSums> spread_;  // in the place of sums_
  std::optional<SplatFilms> splats_;
  std::vector<PendingSplat> pending_;
  double splatUnit_ = 0;
  uint64_t splatCount_ = 0;
};

}  // namespace wavecrest
