// An AgainstResult as JSON (bench/schema.json): every run's CPU seconds, so that others may judge anew.
#include <nlohmann/json.hpp>

#include "bench/against/against.h"

namespace wavecrest {

nlohmann::ordered_json toJson(const AgainstResult& result) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const AgainstRow& row : result.rows) {
    const Comparison& c = row.comparison;
    rows.push_back({{"scene", row.scene},
                    {"method", row.method},
                    {"iterations", row.iterations},
                    {"speedup", c.speedup},
                    {"interval", {c.interval.low, c.interval.high}},
                    {"probability", c.probability},
                    {"verdict", std::string(toString(c.verdict))},
                    {"same_image", row.sameImage},
                    {"image_difference", row.imageDifference},
                    {"cpu_seconds", row.ourSeconds},
                    {"other_cpu_seconds", row.otherSeconds}});
  }
  nlohmann::ordered_json inPlace = nlohmann::ordered_json::array();
  for (const std::filesystem::path& program : result.inPlace) inPlace.push_back(program.string());
  return {{"binary", result.ours.string()},
          {"other_binary", result.other.string()},
          {"other_version", result.otherVersion},
          {"in_place", std::move(inPlace)},
          {"threads", result.threads},
          {"family_level", result.family.level},
          {"tolerance", result.family.tolerance},
          {"interval_level", kIntervalLevel},
          {"comparisons", rows}};
}

}  // namespace wavecrest
