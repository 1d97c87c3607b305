// Medians and their intervals as JSON (bench/schema.json).
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "bench/statistics/medians.h"

namespace wavecrest {

inline nlohmann::ordered_json intervalJson(const Interval& interval) { return {interval.low, interval.high}; }

// A figure under its name, and its interval beside it.
inline void addEstimate(nlohmann::ordered_json& object, const std::string& name, const Estimate& estimate,
                        double scale = 1) {
  object[name] = scale * estimate.value;
  object[name + "_interval"] = {scale * estimate.interval.low, scale * estimate.interval.high};
}

}  // namespace wavecrest
