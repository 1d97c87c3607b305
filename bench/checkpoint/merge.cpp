#include "bench/checkpoint/merge.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string_view>

#include "bench/until/film_error.h"
#include "engine/state/state_stream.h"

namespace wavecrest {
namespace {

using Json = nlohmann::ordered_json;

// What says which share of the image a checkpoint is of; the rest of its identity is common to all.
constexpr std::array<std::string_view, 2> kShareKeys{"first_iteration", "part"};

// How far the images of parts lie apart.
class Spread {
 public:
  // weight: iterations of the image.
  void add(const std::vector<float>& image, double weight) {
    sums_.resize(image.size());
    squares_.resize(image.size());
    for (size_t i = 0; i < image.size(); ++i) {
      const double value = image[i];
      sums_[i] += weight * value;
      squares_[i] += weight * value * value;
    }
    weight_ += weight;
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

 private:
  std::vector<double> sums_, squares_;  // of each sample, weighted
  double weight_ = 0;
  size_t parts_ = 0;
};

bool isSummed(std::string_view key) {
  constexpr std::array<std::string_view, 21> kKeys{"camera_paths",   "light_paths",         "mutations",
                                                   "rays_closest",   "rays_shadow",         "connections",
                                                   "merges",         "load_seconds",        "build_seconds",
                                                   "render_seconds", "render_wall_seconds", "wall_seconds",
                                                   "cpu_seconds",    "nonfinite_samples",   "saturated_splats",
                                                   "close_pairs",    "paths_cut",           "throughput_cut",
                                                   "cut_energy",     "direct_paths",        "parts"};
  return std::find(kKeys.begin(), kKeys.end(), key) != kKeys.end();
}

// Scalars of the statistics of all parts: sums, and what is the same in all.
void addStats(Json& stats, const Json& more) {
  Json sum = Json::object();
  for (const auto& [key, value] : stats.items()) {
    const auto other = more.find(key);
    if (other == more.end() || !value.is_primitive()) continue;
    if (!isSummed(key)) {
      if (value == *other) sum[key] = value;
    } else if (value.is_number_float() || other->is_number_float()) {
      sum[key] = value.get<double>() + other->get<double>();
    } else if (value.is_number() && other->is_number()) {
      sum[key] = value.get<uint64_t>() + other->get<uint64_t>();
    }
  }
  stats = std::move(sum);
}

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

// The film and the work of one part. The header is the one that was read before.
std::unique_ptr<Film> readPart(const std::string& file, const CheckpointHeader& header, WorkDone& work) {
  const Checkpoint part(file);
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

MergedParts mergeParts(const std::vector<std::string>& files) {
  const std::vector<CheckpointHeader> headers = readHeaders(files);
  std::vector<size_t> order(files.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return beginOf(headers[a].holds) < beginOf(headers[b].holds); });
  MergedParts merged;
  Spread spread;
  bool comparable = true;
  Json stats;
  double seconds = 0;
  for (const size_t index : order) {
    const CheckpointHeader& header = headers[index];
    WorkDone work;
    std::unique_ptr<Film> film = readPart(files[index], header, work);
    // The image of the part alone, weighted by what made it.
    const uint64_t weight = film->splatCount() != 0 ? film->splatCount() : film->maxSamples();
    if (files.size() > 1) spread.add(film->resolve(), static_cast<double>(weight));
    // Pixels of a part without samples are black whatever the image.
    comparable = comparable && (film->minSamples() != 0 || film->maxSamples() == 0);
    if (!merged.film) {
      merged = {.header = header, .film = std::move(film), .work = std::move(work), .missing = {}, .relativeError = {}};
      stats = statsOf(header);
    } else {
      comparable = comparable && (film->maxSamples() == 0) == (merged.film->maxSamples() == 0);
      try {
        merged.film->add(*film);
        merged.work += work;
      } catch (const StateError& error) {
        failCheckpoint(files[index], error.what(), "expected parts of one render");
      }
      merged.header.holds.add(header.holds);
      addStats(stats, statsOf(header));
    }
    seconds += secondsIn(header);
  }
  const Holdings& holds = merged.header.holds;
  stats["iterations"] = iterationsOf(holds);
  merged.missing = holds.missing(merged.header.render.value("chains", uint64_t{0}));
  if (comparable && merged.header.render.value("sampler", "") != "sobol") {
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
