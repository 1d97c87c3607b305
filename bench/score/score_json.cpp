// A ScoreResult as JSON: base units, as bench/schema.json describes.
#include <nlohmann/json.hpp>

#include "bench/enumerator_name.h"
#include "bench/estimate_json.h"
#include "bench/score/score.h"
#include "engine/scene/hash_text.h"

namespace wavecrest {
namespace {

using Json = nlohmann::ordered_json;

// Events per item by name; null where events are not counted.
Json eventsJson(const ScoredStage& stage, const ScoreResult& result) {
  if (!result.eventsRefusal.empty()) return {};
  Json events;
  for (size_t i = 0; i < kStageEvents; ++i) events[kHardwareEventNames[i]] = stage.eventsPerItem[i];
  return events;
}

// null stands for a stage without blocks of lanes, or without a known contract.
Json stageJson(const ScoredStage& stage, const ScoreResult& result) {
  const StageShare& share = stage.share;
  const double seconds = 1e-9 * share.nsPerItem.value;
  Json json = {{"name", share.name}, {"items_per_path", share.itemsPerPath}};
  json["seconds_per_item"] = seconds;
  json["seconds_per_path"] = 1e-9 * share.nsPerPath.value;
  json["share"] = share.share.value;
  json["lane_use"] = share.laneUse ? Json(*share.laneUse) : Json();
  json["bytes_per_item"] = stage.bytesPerItem ? Json(*stage.bytesPerItem) : Json();
  json["bytes_per_second"] =
      stage.bytesPerItem && seconds > 0 ? Json(static_cast<double>(*stage.bytesPerItem) / seconds) : Json();
  // Not a count of operations: how many the stage's time would suffice for at the measured peak.
  json["operations_per_item_at_peak"] = seconds * result.ceilings.operationsPerSecond;
  json["events_per_item"] = eventsJson(stage, result);
  return json;
}

// null where pictures were not compared.
Json differenceJson(const std::optional<PictureDifference>& difference) {
  if (!difference) return {};
  return {{"ssim", difference->ssim},
          {"worst_block_ssim", difference->worstBlockSsim},
          {"mean_off", difference->meanOff},
          {"worst_block_mean_off", difference->worstBlockMeanOff}};
}

// One entry of the workload: its image, scores, rates, quality over time, and stages.
Json rowJson(const ScoreRow& row, const ScoreResult& result) {
  Json json = {{"scene", row.entry.scene},
               {"method", std::string(toString(row.entry.method))},
               {"width", row.entry.width},
               {"height", row.entry.height},
               {"iterations", row.entry.iterations},
               {"image_hash", hashText(row.image.hash)},
               {"image", enumeratorName(kValidityNames, row.image.validity)},
               {"image_verdict", row.image.text},
               {"image_difference", differenceJson(row.image.difference)},
               {"score", row.score},
               {"core_score", row.coreScore}};
  addEstimate(json, "paths_per_second", row.pathsPerSecond);
  addEstimate(json, "paths_per_cpu_second", row.pathsPerCpuSecond);
  json["processes_paths_per_second"] = row.processesPathsPerSecond;
  json["specialization"] = enumeratorName(kSpecializationNames, row.facts.specialization);
  json["accel"] = enumeratorName(kAccelNames, row.facts.accel);
  json["bytes_per_path"] = row.facts.bytesPerPath;
  // relMSE after slices 1, 2, 4 and 8.
  json["quality"] = Json::array();
  for (const QualityAtTime& at : row.quality) {
    json["quality"].push_back({{"seconds", at.seconds},
                               {"cpu_seconds", at.cpuSeconds},
                               {"samples_per_pixel", at.samplesPerPixel},
                               {"relmse", at.relmse}});
  }
  json["stages"] = Json::array();
  for (const ScoredStage& stage : row.stages) json["stages"].push_back(stageJson(stage, result));
  return json;
}

}  // namespace

Json toJson(const ScoreResult& result) {
  // All rows, and the score of each method that has rows.
  Json methods = Json::object();
  Json rows = Json::array();
  for (const ScoreRow& row : result.rows) {
    rows.push_back(rowJson(row, result));
    // The same score for each row of a method.
    methods[std::string(toString(row.entry.method))] = result.score(row.entry.method);
  }
  return {{"score_version", kScoreVersion},
          {"size", enumeratorName(kScoreSizeNames, result.size)},
          {"isa", std::string(toString(result.isa))},
          {"threads", result.threads},
          {"compiler", compilerName()},
          {"build", buildName()},
          {"reference_machine", referenceMachine().name},
          {"valid", result.allAccepted()},
          {"score", result.score()},
          {"core_score", result.coreScore()},
          {"method_scores", methods},
          {"interval_level", kIntervalLevel},
          {"ceilings",
           {{"cache_bytes_per_second", result.ceilings.cacheBytesPerSecond},
            {"memory_bytes_per_second", result.ceilings.memoryBytesPerSecond},
            {"operations_per_second", result.ceilings.operationsPerSecond}}},
          {"events_refusal", result.eventsRefusal.empty() ? Json() : Json(result.eventsRefusal)},
          {"entries", rows},
          {"doubts", result.doubts()}};
}

}  // namespace wavecrest
