#include "bench/throughput/speed.h"

#include <algorithm>

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

// The part of a slice's time that a stage took: the session's clock goes on while another program has the core, but so
// it does in the other stages.
double shareOf(const Slice& slice, size_t stage) { return slice.stages[stage].seconds / slice.seconds; }

// times: of each stage in CPU time, if they could be measured apart. slices: of one thread.
std::vector<StageShare> stageShares(const std::vector<Slice>& slices, const std::optional<StageTimes>& times,
                                    double pathsPerCpuSecond) {
  std::vector<StageShare> shares;
  for (size_t i = 0; i < slices.front().stages.size(); ++i) {
    StageShare& share = shares.emplace_back();
    share.name = slices.front().stages[i].name;
    const auto items = [i](const Slice& s) { return static_cast<double>(s.stages[i].items); };
    share.itemsPerPath = medianOf(slices, [&](const Slice& s) { return items(s) / static_cast<double>(s.paths); });
    const auto slots = [i](const Slice& s) { return static_cast<double>(s.stages[i].laneSlots); };
    if (std::all_of(slices.begin(), slices.end(), [&](const Slice& s) { return slots(s) > 0; })) {
      share.laneUse = medianOf(slices, [&](const Slice& s) { return items(s) / slots(s); });
    }
    if (times) {
      share.nsPerPath = 1e9 * times->seconds[i] / static_cast<double>(times->paths);
      share.share = 1e-9 * share.nsPerPath * pathsPerCpuSecond;
    } else {
      share.share = medianOf(slices, [i](const Slice& s) { return shareOf(s, i); });
      share.nsPerPath = 1e9 * share.share / pathsPerCpuSecond;
    }
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
  const auto slices =
      renderInTurn(sessions, seconds / static_cast<double>((kScalingRounds + 1) * sessions.size()), kScalingRounds);
  const auto& one = slices.front();
  const auto& all = slices.back();

  Speed speed;
  speed.facts = sessions.front()->statistics();
  speed.bytesPerPath = speed.facts.bytesPerPath;
  speed.pathsPerSecond = medianOf(all, [](const Slice& s) { return s.pathsPerSecond(); });
  speed.raysPerSecond = medianOf(all, [](const Slice& s) { return s.rays() / s.seconds; });
  speed.pathsPerCpuSecond = medianOf(one, [](const Slice& s) { return s.pathsPerCpuSecond(); });
  speed.raysPerPath = medianOf(one, [](const Slice& s) { return s.rays() / static_cast<double>(s.paths); });
  speed.raysPerCpuSecond = medianOf(one, [](const Slice& s) { return s.rays() / s.cpuSeconds; });
  speed.stages = stageShares(one, measureStageTimes(scene, settings, 0.3 * seconds), speed.pathsPerCpuSecond);
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
