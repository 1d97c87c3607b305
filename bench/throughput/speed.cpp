#include "bench/throughput/speed.h"

#include "bench/throughput/turns.h"

namespace wavecrest {
namespace {

constexpr size_t kFewestSpeedRounds = 3, kMostSpeedRounds = 15;

std::vector<uint32_t> threadCounts(uint32_t most) {
  std::vector<uint32_t> counts;
  for (uint32_t n = 1; n < most; n *= 2) counts.push_back(n);
  counts.push_back(most);
  return counts;
}

template <class Projection>
Estimate estimateOf(const std::vector<Slice>& slices, Projection&& projection) {
  return estimateMedian(valuesOf(slices, projection));
}

// Of each round the ratio of two sessions' figures: what holds up a whole round falls out.
template <class Projection>
Estimate estimateRatio(const std::vector<Slice>& slices, const std::vector<Slice>& base, Projection&& projection) {
  std::vector<double> ratios = valuesOf(slices, projection);
  const std::vector<double> below = valuesOf(base, projection);
  for (size_t i = 0; i < ratios.size(); ++i) ratios[i] /= below[i];
  return estimateMedian(ratios);
}

// A stage's row of one slice. Its seconds are of the time-stamp counter, which goes on while another program has the
// core, as the slice's wall time does; so a share is their ratio.
double shareIn(const Slice& slice, size_t stage) { return slice.stages[stage].seconds / slice.seconds; }

Estimate scaled(Estimate estimate, double factor) {
  return {estimate.value * factor, {estimate.interval.low * factor, estimate.interval.high * factor}};
}

double restIn(const Slice& slice) {
  double rest = 1;
  for (size_t i = 0; i < slice.stages.size(); ++i) rest -= shareIn(slice, i);
  return rest;
}

double wallRate(const Slice& slice) { return slice.pathsPerSecond(); }
double cpuRate(const Slice& slice) { return slice.pathsPerCpuSecond(); }

}  // namespace

std::vector<StageShare> stageShares(const std::vector<Slice>& slices) {
  std::vector<StageShare> shares;
  for (size_t i = 0; i < slices.front().stages.size(); ++i) {
    StageShare& share = shares.emplace_back();
    share.name = slices.front().stages[i].name;
    double items = 0, laneSlots = 0, paths = 0;
    for (const Slice& slice : slices) {
      items += static_cast<double>(slice.stages[i].items);
      laneSlots += static_cast<double>(slice.stages[i].laneSlots);
      paths += static_cast<double>(slice.paths);
    }
    share.itemsPerPath = items / paths;
    if (laneSlots != 0) share.laneUse = items / laneSlots;
    share.share = estimateOf(slices, [i](const Slice& s) { return shareIn(s, i); });
    share.nsPerPath = estimateOf(slices, [i](const Slice& s) { return 1e9 * shareIn(s, i) / s.pathsPerCpuSecond(); });
    if (items > 0) share.nsPerItem = scaled(share.nsPerPath, 1 / share.itemsPerPath);
  }
  return shares;
}

Speed measureSpeed(const Scene& scene, const RenderSettings& settings, double seconds) {
  const std::vector<uint32_t> threads = threadCounts(settings.threads);
  std::vector<std::unique_ptr<Session>> sessions;
  for (const uint32_t count : threads) {
    RenderSettings own = settings;
    own.threads = count;
    own.measureStages = true;
    sessions.push_back(Session::create(scene, own));
  }
  MachineWatch watch;
  auto slices =
      renderInTurn(sessions, {.seconds = seconds, .fewestRounds = kFewestSpeedRounds, .mostRounds = kMostSpeedRounds},
                   [&] { watch.look(); });
  const std::vector<Slice>&one = slices.front(), &all = slices.back();

  Speed speed{.pathsPerSecond = estimateOf(all, wallRate),
              .raysPerSecond = estimateOf(all, [](const Slice& s) { return s.rays() / s.seconds; }),
              .pathsPerCpuSecond = estimateOf(one, cpuRate),
              .raysPerCpuSecond = estimateOf(one, [](const Slice& s) { return s.rays() / s.cpuSeconds; }),
              .stages = stageShares(one),
              .restShare = estimateOf(one, restIn),
              .scaling = {},
              .facts = sessions.front()->statistics(),
              .machine = watch.state()};
  double rays = 0, paths = 0;
  for (const Slice& slice : one) {
    rays += slice.rays();
    paths += static_cast<double>(slice.paths);
  }
  speed.raysPerPath = rays / paths;
  speed.bytesPerPath = speed.facts.bytesPerPath;
  for (size_t i = 0; i < threads.size(); ++i) {
    speed.scaling.push_back({.threads = threads[i],
                             .pathsPerSecond = estimateOf(slices[i], wallRate),
                             .speedup = estimateRatio(slices[i], one, wallRate),
                             .cpuEfficiency = estimateRatio(slices[i], one, cpuRate),
                             .slices = slices[i]});
  }
  return speed;
}

}  // namespace wavecrest
