// A ScalingResult as JSON (bench/schema.json).
#include <nlohmann/json.hpp>

#include "bench/estimate_json.h"
#include "bench/scaling/scaling.h"

namespace wavecrest {

using Json = nlohmann::ordered_json;

Json toJson(const ScalingResult& result) {
  Json measured = Json::array(), predicted = Json::array(), parts = Json::array();
  for (const MeasuredScaling& row : result.measured) {
    measured.push_back({{"threads", row.threads},
                        {"paths_per_second", row.pathsPerSecond.value},
                        {"paths_per_second_interval", intervalJson(row.pathsPerSecond.interval)},
                        {"speedup", row.speedup.value},
                        {"speedup_interval", intervalJson(row.speedup.interval)},
                        {"process_speedup", row.processSpeedup}});
  }
  for (const PredictedScaling& row : result.predicted) {
    predicted.push_back({{"threads", row.threads},
                         {"speedup", row.speedup.value},
                         {"speedup_interval", intervalJson(row.speedup.interval)},
                         {"parallelism", row.parallelism.value},
                         {"parallelism_interval", intervalJson(row.parallelism.interval)},
                         {"tasks", row.tasks},
                         {"longest_task_seconds", row.longestTask}});
  }
  for (const PartsScaling& row : result.parts) {
    parts.push_back({{"machines", row.machines}, {"snapshot_bytes", row.bytes}, {"merge_seconds", row.mergeSeconds}});
  }
  return {{"scene", result.scene}, {"method", std::string(toString(result.method))},
          {"width", result.width}, {"height", result.height},
          {"measured", measured},  {"predicted", predicted},
          {"parts", parts},        {"doubts", doubtsAbout(result.machine)}};
}

}  // namespace wavecrest
