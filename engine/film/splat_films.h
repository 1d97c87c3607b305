// Where splats are summed up: a bounded number of films of sums, whatever the number of threads.
//
// A worker's splats wait in a queue of its wave (kernels/columns/records.h) and are added to one of the films some
// times a wave. Up to kSplatFilms workers have a film each. More workers share them: a queue is sorted by regions of
// the film, and each region is added under a lock of its own, so that workers rarely wait. Sums are integers, so the
// image is the same bit for bit whichever film and order they were added in.
#pragma once

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <vector>

#include "kernels/stages.h"

namespace wavecrest {

class StateReader;
class StateWriter;

constexpr size_t kSplatFilms = 2;

// One film's sums. Pages of the high halves that no splat has reached take no memory.
class SplatFilm {
 public:
  SplatFilm(size_t pixels, size_t regions, double scale);
  const SplatSums& sums() const { return sums_; }
  std::mutex& lockOf(size_t region) { return locks_[region]; }

 private:
  struct Free {
    void operator()(uint64_t* p) const { std::free(p); }
  };
  std::unique_ptr<uint64_t, Free> low_, high_;
  std::unique_ptr<std::mutex[]> locks_;
  SplatSums sums_;
};

class SplatFilms {
 public:
  // scale: units in 1, a power of two. threads: how many workers may add splats at the same time.
  SplatFilms(size_t pixels, size_t threads, double scale);

  double scale() const { return scale_; }
  // Regions are runs of 2^regionBits pixels, row by row; there is one where every worker has a film of its own.
  uint32_t regionBits() const { return regionBits_; }
  size_t regions() const { return regions_; }
  // The film of the next worker.
  SplatFilm& assign() { return *films_[nextFilm_++ % films_.size()]; }

  // One splat more; rgb: finite.
  void add(uint32_t pixel, const double (&rgb)[3]);

  // Adds the sums of another film of the same size and scale. No worker may be adding.
  void add(const SplatFilms& other);
  // The same of sums that were saved.
  void addSaved(StateReader& in);

  // The sum of a channel over all films, in units of 1 / scale. No worker may be adding.
  double total(size_t channel) const { return static_cast<double>(sum(channel)); }
  // The sums of all films together, for checkpoints; and back into films without splats. No worker may be adding.
  void save(StateWriter& out) const;
  void restore(StateReader& in);

  size_t bytes() const { return bytesFor(pixels_, films_.size()); }
  static size_t bytesFor(size_t pixels, size_t threads);

 private:
  __int128 sum(size_t channel) const;
  // Sets the first film's sum. High halves that stay zero are not written, so that their pages stay unused.
  void setFirst(size_t channel, __int128 sum);
  // Adds to the first film's.
  void addToFirst(size_t channel, __int128 sum);

  size_t pixels_;
  double scale_;
  uint32_t regionBits_;
  size_t regions_;
  std::vector<std::unique_ptr<SplatFilm>> films_;
  std::atomic<size_t> nextFilm_{0};
};

// One worker's way to the films: adds and empties the queue of its wave.
template <class S>
class SplatWriter {
 public:
  // capacity: of the wave's queue.
  SplatWriter(SplatFilms& films, AddSplats<S> addSplats, size_t capacity);
  void drain(Splats<S>& splats, StageCounters& counters);

  size_t bytes() const { return arena_.used(); }
  // The same of each writer, where so many threads have one.
  static size_t bytesFor(size_t pixels, size_t threads, size_t capacity);

 private:
  void sort(const Splats<S>& splats);

  SplatFilms& films_;
  SplatFilm& film_;
  AddSplats<S> addSplats_;
  Arena arena_;
  Splats<S> sorted_;              // of no capacity where there is one region
  std::vector<uint32_t> begins_;  // of each region in sorted_, and the end
};

}  // namespace wavecrest
