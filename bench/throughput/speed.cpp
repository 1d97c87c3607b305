#include "bench/throughput/speed.h"

#include "bench/throughput/stage_times.h"
#include "bench/throughput/turns.h"

namespace wavecrest {
namespace {

constexpr size_t kScalingRounds = 7;

std::vector<uint32_t> threadCounts(uint32_t most) {
  std::vector<uint32_t> counts;
  for (uint32_t n = 1; n < most; n *= 2) counts.push_back(n);
  counts.push_back(most);
  return counts;
}

// What was done in all slices together: a short one may have no path, and a stage need not run in each.
struct Totals {
  double paths = 0, rays = 0, seconds = 0;
};
Totals totalsOf(const std::vector<Slice>& slices) {
  Totals totals;
  for (const Slice& slice : slices) {
    totals.paths += static_cast<double>(slice.paths);
    totals.rays += slice.rays();
    totals.seconds += slice.seconds;
  }
  return totals;
}
RenderStatistics::StageRow totalOf(const std::vector<Slice>& slices, size_t stage) {
  RenderStatistics::StageRow total{.name = slices.front().stages[stage].name};
  for (const Slice& slice : slices) {
    const RenderStatistics::StageRow& row = slice.stages[stage];
    total.items += row.items;
    total.laneSlots += row.laneSlots;
    total.seconds += row.seconds;
  }
  return total;
}

// times: of each stage in CPU time, where they can be measured apart. Otherwise a stage's share is its part of the
// slices' time: the session's clock goes on while another program has the core, but so it does in the other stages.
// slices: of one thread.
std::vector<StageShare> stageShares(const std::vector<Slice>& slices, const StageTimes& times,
                                    double pathsPerCpuSecond) {
  const Totals all = totalsOf(slices);
  std::vector<StageShare> shares;
  for (size_t i = 0; i < slices.front().stages.size(); ++i) {
    const RenderStatistics::StageRow total = totalOf(slices, i);
    const auto items = static_cast<double>(total.items);
    StageShare& share = shares.emplace_back();
    share.name = total.name;
    share.itemsPerPath = items / all.paths;
    if (total.laneSlots != 0) share.laneUse = items / static_cast<double>(total.laneSlots);
    share.share = times.possible() ? times.secondsPerPath(i) * pathsPerCpuSecond : total.seconds / all.seconds;
    share.nsPerPath = 1e9 * share.share / pathsPerCpuSecond;
    share.nsPerItem = share.itemsPerPath > 0 ? share.nsPerPath / share.itemsPerPath : 0;
  }
  return shares;
}

}  // namespace

Speed measureSpeed(const Scene& scene, const RenderSettings& settings, double seconds) {
  const std::vector<uint32_t> threads = threadCounts(settings.threads);
  std::vector<std::unique_ptr<Session>> sessions;
  for (const uint32_t count : threads) {
    RenderSettings own = settings;
    own.threads = count;
    own.measureStages = true;
    sessions.push_back(Session::create(scene, own));
  }
  StageTimes stageTimes(scene, settings);
  const auto slices = renderInTurn(sessions, seconds / static_cast<double>((kScalingRounds + 1) * sessions.size()),
                                   kScalingRounds, [&] {
                                     if (stageTimes.possible()) stageTimes.measureFor(0.3 * seconds / kScalingRounds);
                                   });
  const auto& one = slices.front();
  const auto& all = slices.back();

  Speed speed;
  speed.facts = sessions.front()->statistics();
  speed.bytesPerPath = speed.facts.bytesPerPath;
  speed.pathsPerSecond = medianOf(all, [](const Slice& s) { return s.pathsPerSecond(); });
  speed.raysPerSecond = medianOf(all, [](const Slice& s) { return s.rays() / s.seconds; });
  speed.pathsPerCpuSecond = medianOf(one, [](const Slice& s) { return s.pathsPerCpuSecond(); });
  const Totals byOne = totalsOf(one);
  speed.raysPerPath = byOne.rays / byOne.paths;
  speed.raysPerCpuSecond = medianOf(one, [](const Slice& s) { return s.rays() / s.cpuSeconds; });
  speed.stages = stageShares(one, stageTimes, speed.pathsPerCpuSecond);
  speed.restShare = 1;
  for (const StageShare& stage : speed.stages) speed.restShare -= stage.share;
  const double baseWall = medianOf(one, [](const Slice& s) { return s.pathsPerSecond(); });
  for (size_t i = 0; i < threads.size(); ++i) {
    const double wall = medianOf(slices[i], [](const Slice& s) { return s.pathsPerSecond(); });
    const double cpu = medianOf(slices[i], [](const Slice& s) { return s.pathsPerCpuSecond(); });
    speed.scaling.push_back({threads[i], wall, wall / baseWall, cpu / speed.pathsPerCpuSecond});
  }
  return speed;
}

}  // namespace wavecrest
