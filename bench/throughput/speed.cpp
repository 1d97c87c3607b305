#include "bench/throughput/speed.h"

#include <algorithm>

#include "bench/throughput/turns.h"

namespace wavecrest {
namespace {

constexpr size_t kMostRoundsOfVisit = 5;

// 1, 2, 4, ... below `most`, and `most` itself.
std::vector<uint32_t> threadCounts(uint32_t most) {
  std::vector<uint32_t> counts;
  for (uint32_t n = 1; n < most; n *= 2) counts.push_back(n);
  counts.push_back(most);
  return counts;
}

// Median and interval over visits of the figure that projection(slice) returns.
template <class Projection>
Estimate estimateOf(const VisitSlices& slices, Projection&& projection) {
  std::vector<std::vector<double>> visits;
  for (const std::vector<Slice>& visit : slices) visits.push_back(valuesOf(visit, projection));
  return estimateMedianOfVisits(visits);
}

// Of each round the ratio of two sessions' figures: what holds up a whole round falls out.
template <class Projection>
Estimate estimateRatio(const VisitSlices& slices, const VisitSlices& base, Projection&& projection) {
  std::vector<std::vector<double>> visits;
  for (size_t visit = 0; visit < slices.size(); ++visit) {
    std::vector<double>& ratios = visits.emplace_back(valuesOf(slices[visit], projection));
    const std::vector<double> below = valuesOf(base[visit], projection);
    for (size_t i = 0; i < ratios.size(); ++i) ratios[i] /= below[i];
  }
  return estimateMedianOfVisits(visits);
}

// A stage's row of one slice. Its seconds are of the time-stamp counter, which goes on while another program has the
// core, as the slice's wall time does; so a share is their ratio.
double shareIn(const Slice& slice, size_t stage) { return slice.stages[stage].seconds / slice.seconds; }

Estimate scaled(Estimate estimate, double factor) {
  return {estimate.value * factor, {estimate.interval.low * factor, estimate.interval.high * factor}};
}

// Share of a slice's time outside all stages: film and schedule.
double restIn(const Slice& slice) {
  double rest = 1;
  for (size_t i = 0; i < slice.stages.size(); ++i) rest -= shareIn(slice, i);
  return rest;
}

double wallRate(const Slice& slice) { return slice.pathsPerSecond(); }
double cpuRate(const Slice& slice) { return slice.pathsPerCpuSecond(); }

}  // namespace

std::vector<Slice> allSlices(const VisitSlices& visits) {
  std::vector<Slice> all;
  for (const std::vector<Slice>& slices : visits) all.insert(all.end(), slices.begin(), slices.end());
  return all;
}

std::vector<StageShare> stageShares(const VisitSlices& slices) {
  const std::vector<RenderStatistics::StageRow>& rows = slices.front().front().stages;
  std::vector<StageShare> shares;
  for (size_t i = 0; i < rows.size(); ++i) {
    StageShare& share = shares.emplace_back();
    share.name = rows[i].name;
    // Counts have no noise from the machine, so they are summed over all slices.
    double items = 0, laneSlots = 0, paths = 0;
    for (const Slice& slice : allSlices(slices)) {
      items += static_cast<double>(slice.stages[i].items);
      laneSlots += static_cast<double>(slice.stages[i].laneSlots);
      paths += static_cast<double>(slice.paths);
    }
    share.itemsPerPath = items / paths;
    if (laneSlots != 0) share.laneUse = items / laneSlots;
    // Times are medians. A stage's CPU time per path is its share of the slice's CPU time per path.
    share.share = estimateOf(slices, [i](const Slice& s) { return shareIn(s, i); });
    share.nsPerPath = estimateOf(slices, [i](const Slice& s) { return 1e9 * shareIn(s, i) / s.pathsPerCpuSecond(); });
    if (items > 0) share.nsPerItem = scaled(share.nsPerPath, 1 / share.itemsPerPath);
  }
  return shares;
}

SpeedMeasurement::SpeedMeasurement(const Scene& scene, const RenderSettings& settings)
    : scene_(scene), settings_(settings), threads_(threadCounts(settings.threads)), slices_(threads_.size()) {
  settings_.measureStages = true;
}

std::vector<std::unique_ptr<Session>> SpeedMeasurement::makeSessions() const {
  std::vector<std::unique_ptr<Session>> sessions;
  for (const uint32_t count : threads_) {
    RenderSettings own = settings_;
    own.threads = count;
    sessions.push_back(Session::create(scene_, own));
  }
  return sessions;
}

void SpeedMeasurement::findIterations(double sliceSeconds) {
  const auto sessions = makeSessions();
  for (const auto& session : sessions) {
    SliceRenderer renderer(*session);
    renderer.fill(sliceSeconds);
    iterations_.push_back(renderer.iterations());
  }
  // Later iterations of these methods are other work than earlier ones: a radius shrinks, a guide learns.
  if (strategiesOf(settings_.method).merge || mayLearn(settings_)) {
    std::fill(iterations_.begin(), iterations_.end(), iterations_.front());
  }
}

void SpeedMeasurement::visit(double seconds) {
  if (iterations_.empty()) findIterations(seconds / static_cast<double>((kMostRoundsOfVisit + 1) * threads_.size()));
  // Sessions of this visit. Their first slices fill caches and start threads; chains bootstrap.
  const auto sessions = makeSessions();
  std::vector<SliceRenderer> renderers;
  for (size_t i = 0; i < sessions.size(); ++i) {
    renderers.emplace_back(*sessions[i], iterations_[i]);
    renderers.back().render();
  }
  // Slices of all thread counts in turn.
  auto slices = renderInTurn(renderers, {.seconds = seconds, .fewestRounds = 1, .mostRounds = kMostRoundsOfVisit},
                             [&] { watch_.look(); });
  for (size_t i = 0; i < slices.size(); ++i) slices_[i].push_back(std::move(slices[i]));
  facts_ = sessions.front()->statistics();
}

Speed SpeedMeasurement::speed() const {
  // Thread counts ascend: the first is one thread, the last is all threads.
  const VisitSlices &one = slices_.front(), &all = slices_.back();
  Speed speed{.pathsPerSecond = estimateOf(all, wallRate),
              .raysPerSecond = estimateOf(all, [](const Slice& s) { return s.rays() / s.seconds; }),
              .pathsPerCpuSecond = estimateOf(one, cpuRate),
              .raysPerCpuSecond = estimateOf(one, [](const Slice& s) { return s.rays() / s.cpuSeconds; }),
              .stages = stageShares(one),
              .restShare = estimateOf(one, restIn),
              .scaling = {},
              .facts = facts_,
              .machine = watch_.state()};
  // Rays per path: a ratio of counts over all slices.
  double rays = 0, paths = 0;
  for (const Slice& slice : allSlices(one)) {
    rays += slice.rays();
    paths += static_cast<double>(slice.paths);
  }
  speed.raysPerPath = rays / paths;
  speed.bytesPerPath = speed.facts.bytesPerPath;
  // Each thread count against one thread.
  for (size_t i = 0; i < threads_.size(); ++i) {
    speed.scaling.push_back({.threads = threads_[i],
                             .pathsPerSecond = estimateOf(slices_[i], wallRate),
                             .speedup = estimateRatio(slices_[i], one, wallRate),
                             .cpuEfficiency = estimateRatio(slices_[i], one, cpuRate),
                             .slices = slices_[i]});
  }
  return speed;
}

}  // namespace wavecrest
