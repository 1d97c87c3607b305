// A ScoreResult for a terminal: a line for each entry, stages by method, and the scores.
#include <fmt/format.h>

#include <algorithm>

#include "bench/enumerator_name.h"
#include "bench/score/score.h"
#include "bench/text_lines.h"

namespace wavecrest {
namespace {

// A stage of a method over all scenes, each of which counts alike: sums of what it does per path.
struct StageSum {
  std::string name;
  double items = 0, slots = 0, ns = 0, bytes = 0, share = 0;
  std::array<double, kStageEvents> events{};

  void add(const ScoredStage& stage) {
    const StageShare& s = stage.share;
    items += s.itemsPerPath;
    // Lanes per path: the sums of items and of lanes give the lane use over all scenes.
    if (s.laneUse && *s.laneUse > 0) slots += s.itemsPerPath / *s.laneUse;
    ns += s.nsPerPath.value;
    share += s.share.value;
    bytes += static_cast<double>(stage.bytesPerItem.value_or(0)) * s.itemsPerPath;
    for (size_t k = 0; k < kStageEvents; ++k) events[k] += stage.eventsPerItem[k] * s.itemsPerPath;
  }
};

// The stages of a method, in the order of their first row. scenes: on how many scenes the method was measured.
std::vector<StageSum> stagesOf(const ScoreResult& result, Method method, size_t& scenes) {
  std::vector<StageSum> sums;
  scenes = 0;
  for (const ScoreRow& row : result.rows) {
    if (row.entry.method != method) continue;
    ++scenes;
    for (const ScoredStage& stage : row.stages) {
      auto found =
          std::find_if(sums.begin(), sums.end(), [&](const StageSum& s) { return s.name == stage.share.name; });
      if (found == sums.end()) {
        sums.push_back({});
        found = sums.end() - 1;
        found->name = stage.share.name;
      }
      found->add(stage);
    }
  }
  return sums;
}

// The table of a method's stages: means over scenes, per path or per item.
void addStages(TextLines& text, const ScoreResult& result, Method method) {
  size_t scenes = 0;
  const std::vector<StageSum> sums = stagesOf(result, method, scenes);
  if (scenes == 0) return;
  const bool events = result.eventsRefusal.empty();
  line(text, "\n  {:<22} {:>8} {:>8} {:>7} {:>7} {:>8} {:>10} {:>10}{}", toString(method), "per path", "ns/item",
       "share", "lanes", "bytes", "of cache", "room, ops", events ? "   cycles  instr.  misses" : "");
  for (const StageSum& sum : sums) {
    if (sum.items == 0) continue;
    const double ns = sum.ns / sum.items;
    const std::string lanes = sum.slots > 0 ? fmt::format("{:.0f} %", 100 * sum.items / sum.slots) : "";
    // Empty for stages without a known contract, and where events are not counted.
    std::string bytes, bandwidth, counts;
    if (sum.bytes > 0) {
      bytes = fmt::format("{:.0f}", sum.bytes / sum.items);
      bandwidth = fmt::format("{:.0f} %", 100 * sum.bytes / sum.ns * 1e9 / result.ceilings.cacheBytesPerSecond);
    }
    if (events) {
      for (const double count : sum.events) counts += fmt::format(" {:>7.1f}", count / sum.items);
    }
    line(text, "  {:<22} {:>8.2f} {:>8.2f} {:>5.1f} % {:>7} {:>8} {:>10} {:>10.0f}{}", sum.name,
         sum.items / static_cast<double>(scenes), ns, 100 * sum.share / static_cast<double>(scenes), lanes, bytes,
         bandwidth, 1e-9 * ns * result.ceilings.operationsPerSecond, counts);
  }
}

// "26 exact, 2 within tolerance".
std::string countsInWords(const ScoreResult& result) {
  std::string words;
  for (size_t i = 0; i < kValidityNames.size(); ++i) {
    const auto count = std::count_if(result.rows.begin(), result.rows.end(), [&](const ScoreRow& row) {
      return row.image.validity == static_cast<Validity>(i);
    });
    if (count > 0) words += fmt::format("{}{} {}", words.empty() ? "" : ", ", count, kValidityNames[i]);
  }
  return words;
}

}  // namespace

// The entry's row of the table that scoreHeading begins, with relMSE and time after the last slice. A second line has
// the verdict if the image is not exact.
std::string toText(const ScoreRow& row) {
  const auto rate = [](const Estimate& e) {
    return fmt::format("{:.3f} +-{:.3f}", 1e-6 * e.value, 1e-6 * e.interval.halfWidth());
  };
  const QualityAtTime& end = row.quality.back();
  std::string text =
      fmt::format("{:<23} {:<4} {:<16} {:>15} {:>15} {:>9.3f} {:>7.0f} {:>7.0f}   {:.2e} at {:.2f} s\n",
                  row.entry.scene, toString(row.entry.method), enumeratorName(kValidityNames, row.image.validity),
                  rate(row.pathsPerSecond), rate(row.pathsPerCpuSecond), 1e-6 * row.processesPathsPerSecond, row.score,
                  row.coreScore, end.relmse, end.seconds);
  if (row.image.validity != Validity::exact) text += fmt::format("    {}\n", row.image.text);
  return text;
}

std::string scoreHeading(const ScoreRequest& request) {
  return fmt::format("score {}: {} thread{}, {}; 100 is {}\n{:<23} {:<4} {:<16} {:>15} {:>15} {:>9} {:>7} {:>7}   {}\n",
                     kScoreSizeNames[static_cast<size_t>(request.size)], request.threads,
                     request.threads == 1 ? "" : "s", toString(request.isa), referenceMachine().name, "scene", "",
                     "image", "M paths/s", "of a core", "processes", "score", "core", "relMSE");
}

std::string toText(const ScoreResult& result) {
  TextLines text;
  // The stages of every method.
  for (const MethodEntry& entry : kMethods) addStages(text, result, entry.method);
  // What a core can do at best, and how to read the columns.
  const Ceilings& peak = result.ceilings;
  line(text, "\n  one thread: {:.0f} GB/s from the second cache, {:.1f} GB/s from memory, {:.0f} G operations/s",
       1e-9 * peak.cacheBytesPerSecond, 1e-9 * peak.memoryBytesPerSecond, 1e-9 * peak.operationsPerSecond);
  line(text,
       "  bytes: of a wave's columns alone, by the stages' contracts; of cache: of its bandwidth; room: operations");
  line(text, "  per item for which the stage's time would suffice at that rate");
  if (!result.eventsRefusal.empty()) {
    line(text, "  cycles, instructions and cache misses are not counted here ({})", result.eventsRefusal);
  }
  line(text, "");
  // Doubts, and the scores of methods and of all.
  for (const std::string& doubt : result.doubts()) line(text, "  doubt: {}", doubt);
  for (const MethodEntry& entry : kMethods) {
    if (result.score(entry.method) == 0) continue;
    line(text, "  {:<4} {:>7.0f}   of a core {:>7.0f}", entry.name, result.score(entry.method),
         result.coreScore(entry.method));
  }
  line(text, "  all  {:>7.0f}   of a core {:>7.0f}{}", result.score(), result.coreScore(),
       result.allAccepted() ? "" : "   NOT VALID");
  line(text, "  images: {}", countsInWords(result));
  return fmt::to_string(text);
}

}  // namespace wavecrest
