#include "bench/checkpoint/merge.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <future>
#include <numeric>
#include <span>
#include <string_view>
#include <utility>

#include "bench/checkpoint/merged_stats.h"
#include "bench/until/film_error.h"
#include "bench/until/until.h"
#include "engine/state/state_stream.h"

namespace wavecrest {
namespace {

using Json = nlohmann::ordered_json;

// How far the images of parts lie apart; and the means of every other one, where halves are asked for.
class Spread {
 public:
  explicit Spread(bool halves) : halves_(halves) {}
  // weight: iterations of the image.
  void add(const std::vector<float>& image, double weight) {
    sums_.resize(image.size());
    squares_.resize(image.size());
    if (halves_) first_.resize(image.size());
    const double first = halves_ && parts_ % 2 == 0 ? weight : 0;
    for (size_t i = 0; i < image.size(); ++i) {
      const double value = image[i];
      sums_[i] += weight * value;
      squares_[i] += weight * value * value;
      if (first != 0) first_[i] += first * value;
    }
    weight_ += weight;
    firstWeight_ += first;
    ++parts_;
  }
  // Of the mean of all. Parts of n_k of n iterations have variances in proportion to 1 / n_k, so that of the mean m is
  // sum_k n_k (x_k - m)^2 / (n (K - 1)).
  std::optional<double> relativeError(const std::vector<float>& mean, size_t width) const {
    if (parts_ < 2) return std::nullopt;
    const std::vector<float> weights = errorWeights(mean, width);
    double sum = 0;
    for (size_t i = 0; i < mean.size(); ++i) {
      const double m = sums_[i] / weight_;
      const double variance = std::max(squares_[i] / weight_ - m * m, 0.0) / static_cast<double>(parts_ - 1);
      sum += double{weights[i]} * variance;
    }
    return std::sqrt(sum / static_cast<double>(mean.size()));
  }

  // Whether there are two halves, of as many iterations each.
  bool isEven() const { return weight_ > 0 && 2 * firstWeight_ == weight_; }
  std::array<std::vector<float>, 2> halves() const {
    std::array<std::vector<float>, 2> images;
    for (size_t i = 0; i < sums_.size(); ++i) {
      images[0].push_back(static_cast<float>(first_[i] / firstWeight_));
      images[1].push_back(static_cast<float>((sums_[i] - first_[i]) / (weight_ - firstWeight_)));
    }
    return images;
  }

 private:
  bool halves_;
  std::vector<double> sums_, squares_;  // of each sample, weighted
  std::vector<double> first_;           // the sums of the first, third, ... part
  double weight_ = 0, firstWeight_ = 0;
  size_t parts_ = 0;
};

Json statsOf(const CheckpointHeader& header) {
  Json stats = header.notes.value("stats", Json::object());
  stats["parts"] = stats.value("parts", 1);
  stats.erase("resumed_from");
  return stats;
}

double secondsIn(const CheckpointHeader& header) { return header.notes.value("wall_seconds", 0.0); }

// Where the share begins, for the order of parts.
uint64_t beginOf(const Holdings& holdings) {
  if (!holdings.runs.empty()) return holdings.runs.front().begin;
  return holdings.chains.empty() ? 0 : holdings.chains.front().part;
}

// Iterations of the whole image that the sum has: of mlt the least of all chains'.
uint64_t iterationsOf(const Holdings& holdings) {
  uint64_t all = 0;
  for (const Holdings::Run& run : holdings.runs) all += run.end - run.begin;
  if (holdings.chains.empty()) return all;
  const auto less = [](const auto& a, const auto& b) { return a.iterations < b.iterations; };
  return std::min_element(holdings.chains.begin(), holdings.chains.end(), less)->iterations;
}

// How many iterations depend on each other, counted from the image's first one.
uint64_t runOf(const CheckpointHeader& header) {
  const bool sobol = header.render.value("sampler", "") == toString(SamplerKind::sobol);
  const std::string_view spread = kFilterModeNames[static_cast<size_t>(FilterMode::spread)];
  return independentRun(sobol ? SamplerKind::sobol : SamplerKind::independent,
                        header.render.value("filter_mode", "") == spread);
}

// Why iterations of different parts depend on each other; empty: they do not. Parts that begin with a run are
// independent. The direct pass of mlt deals the iterations of each run out to all parts.
std::string whyDependent(std::span<const CheckpointHeader> headers) {
  const uint64_t runLength = runOf(headers.front());
  if (runLength == 1) return "";
  const auto isWhole = [&](const Holdings::Run& run) { return run.begin % runLength == 0; };
  const bool independent = std::all_of(headers.begin(), headers.end(), [&](const CheckpointHeader& header) {
    return header.holds.chains.empty() && std::all_of(header.holds.runs.begin(), header.holds.runs.end(), isWhole);
  });
  if (independent) return "";
  return runLength == kSobolRun
             ? "points of one Sobol sequence depend on each other"
             : "each two iterations have mirrored places in the filter, and a part begins between two of them";
}

// Why the parts are no halves of a reference; empty: they are.
std::string whyNoHalves(const MergedParts& merged, const Spread& spread, const std::string& dependence) {
  if (!merged.header.holds.chains.empty()) return "all parts of mlt share the error of b";
  if (!dependence.empty()) return dependence;
  if (!merged.missing.empty()) return "missing are " + merged.missing;
  return spread.isEven() ? "" : "every other part does not have half of the iterations";
}

std::vector<CheckpointHeader> readHeaders(const std::vector<std::string>& files) {
  std::vector<CheckpointHeader> headers;
  for (const std::string& file : files) {
    headers.push_back(readCheckpointHeader(file));
    const CheckpointHeader& own = headers.back();
    requireSameRender(file, own.render, headers.front().render, kShareKeys);
    for (size_t other = 0; other + 1 < headers.size(); ++other) {
      const std::string both = own.holds.overlap(headers[other].holds);
      if (both.empty()) continue;
      failCheckpoint(file, fmt::format("holds {}, as {} does", both, files[other]), "expected every part once");
    }
  }
  return headers;
}

// The film and the work of one part. header: that was read before. The part is done with.
std::unique_ptr<Film> takeFilm(const std::string& file, const std::unique_ptr<Checkpoint> read,
                               const CheckpointHeader& header, WorkDone& work) {
  const Checkpoint& part = *read;
  if (part.header().holds != header.holds || part.header().render != header.render) {
    failCheckpoint(file, "was replaced while parts were read", "expected parts whose renders are over");
  }
  try {
    StateReader in(part.state());
    std::unique_ptr<Film> film = Film::fromState(in);
    work.restore(in);
    return film;
  } catch (const StateError& error) {
    failCheckpoint(file, error.what(), kIntactCheckpoint);
  }
}

}  // namespace

MergedParts mergeParts(const std::vector<std::string>& files, bool halves) {
  const std::vector<CheckpointHeader> headers = readHeaders(files);
  std::vector<size_t> order(files.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return beginOf(headers[a].holds) < beginOf(headers[b].holds); });
  MergedParts merged;
  Spread spread(halves);
  const std::string dependence = whyDependent(headers);
  bool comparable = true;
  std::vector<Json> statsOfParts;
  double seconds = 0;
  // The next part is read while this one is added.
  const auto read = [&](size_t place) {
    return std::async(std::launch::async, [&, place] { return std::make_unique<Checkpoint>(files[order[place]]); });
  };
  std::future<std::unique_ptr<Checkpoint>> next = read(0);
  for (size_t place = 0; place < order.size(); ++place) {
    const size_t index = order[place];
    const CheckpointHeader& header = headers[index];
    std::unique_ptr<Checkpoint> part = next.get();
    if (place + 1 < order.size()) next = read(place + 1);
    WorkDone work;
    std::unique_ptr<Film> film = takeFilm(files[index], std::move(part), header, work);
    // The image of the part alone, weighted by what made it.
    const uint64_t weight = film->splatCount() != 0 ? film->splatCount() : film->maxSamples();
    if (files.size() > 1) spread.add(film->resolve(), static_cast<double>(weight));
    // Pixels of a part without samples are black whatever the image.
    comparable = comparable && (film->minSamples() != 0 || film->maxSamples() == 0);
    if (!merged.film) {
      merged.header = header;
      merged.header.holds.sum = true;  // of one part too: chains and guides are left out
      merged.film = std::move(film);
      merged.work = std::move(work);
    } else {
      comparable = comparable && (film->maxSamples() == 0) == (merged.film->maxSamples() == 0);
      try {
        merged.film->add(*film);
        merged.work += work;
      } catch (const StateError& error) {
        failCheckpoint(files[index], error.what(), "expected parts of one render");
      }
      merged.header.holds.add(header.holds);
    }
    statsOfParts.push_back(statsOf(header));
    seconds += secondsIn(header);
  }
  const Holdings& holds = merged.header.holds;
  merged.header.render["process"] = "1/1";
  if (!holds.runs.empty()) merged.header.render["first_iteration"] = holds.runs.front().begin;
  Json stats = mergedStats(statsOfParts);
  // Whole ones: a part that was stopped has pixels that lack the last one.
  stats["iterations"] = holds.lacking == 0 ? iterationsOf(holds) : merged.film->minSamples();
  merged.missing = holds.missing(merged.header.render.value("chains", uint64_t{0}));
  if (halves) merged.whyNoHalves = whyNoHalves(merged, spread, dependence);
  if (halves && merged.whyNoHalves.empty()) merged.halves = spread.halves();
  if (comparable && dependence.empty()) {
    merged.relativeError = spread.relativeError(merged.film->resolve(), merged.film->area().width);
  }
  if (merged.relativeError) stats["relative_error"] = *merged.relativeError;
  if (!merged.missing.empty()) stats["missing"] = merged.missing;
  // What a render that goes on from the sum expects of the notes.
  merged.header.notes = {
      {"wall_seconds", seconds}, {"snapshot_every", ""}, {"snapshots", Json::array()}, {"stats", stats}};
  return merged;
}

void writeSum(const std::string& file, const MergedParts& merged) {
  writeCheckpoint(file, merged.header, [&](StateWriter& out) {
    merged.film->save(out);
    merged.work.save(out);
  });
}

}  // namespace wavecrest
