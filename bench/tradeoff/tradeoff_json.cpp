// A TradeResult as JSON (bench/schema.json).
#include <nlohmann/json.hpp>

#include "bench/estimate_json.h"
#include "bench/tradeoff/tradeoff.h"

namespace wavecrest {

nlohmann::ordered_json biasJson(const Bias& bias) {
  return {{"value", bias.value}, {"standard_error", bias.standardError}, {"probability", bias.probability}};
}

namespace {

using Json = nlohmann::ordered_json;

Json rowJson(const TradeRow& row) {
  Json json = {{"knob", row.knob}, {"value", row.value}};
  if (!row.refusal.empty()) {
    json["refused"] = row.refusal;
    return json;
  }
  json.update({{"paths_per_cpu_second", row.pathsPerCpuSecond},
               {"speed", row.speed.value},
               {"speed_interval", intervalJson(row.speed.interval)},
               {"efficiency", row.efficiency.value},
               {"efficiency_interval", intervalJson(row.efficiency.interval)},
               {"cpu_seconds_to_percent", row.secondsToPercent},
               {"bias", biasJson(row.mean)},
               {"worst_block", biasJson(row.worstBlock)},
               {"biased", row.biased},
               {"same_paths", row.samePaths},
               {"bytes", row.bytes},
               {"joules_per_path", row.joulesPerPath ? Json(*row.joulesPerPath) : Json()}});
  return json;
}

}  // namespace

Json toJson(const TradeResult& result) {
  Json rows = Json::array();
  for (const TradeRow& row : result.rows) rows.push_back(rowJson(row));
  return {{"scene", result.scene},
          {"method", std::string(toString(result.method))},
          {"reference_method", std::string(toString(result.referenceMethod))},
          {"width", result.width},
          {"height", result.height},
          {"seeds", result.seeds},
          {"iterations", result.iterations},
          {"level", kTradeLevel},
          {"verdicts", verdictsOf(result.rows)},
          {"bias_told", tellsBias(result.seeds)},
          {"rows", rows},
          {"advice", adviceOf(result)},
          {"doubts", doubtsAbout(result)}};
}

}  // namespace wavecrest
