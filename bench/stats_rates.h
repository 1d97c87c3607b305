// Rates in the statistics of a render, of `render --stats` and of sums of parts alike.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "engine/methods/method_list.h"

namespace wavecrest {

// Sets `paths_per_second` and `rays_per_second` from the counts and the render time of the same object: 0 before any
// time has passed. Light tracing counts its light paths, whichever option named it.
inline void setRates(nlohmann::ordered_json& stats) {
  const auto seconds = stats.at("render_seconds").get<double>();
  const auto count = [&](const char* key) { return stats.at(key).get<uint64_t>(); };
  const auto perSecond = [&](uint64_t all) { return seconds > 0 ? static_cast<double>(all) / seconds : 0.0; };
  const nlohmann::ordered_json& method =
      stats.contains("choice") ? stats.at("choice").at("method") : stats.at("method");
  const bool tracesLight = method.get<std::string>() == toString(Method::lt);
  stats["paths_per_second"] = perSecond(count(tracesLight ? "light_paths" : "camera_paths"));
  stats["rays_per_second"] = perSecond(count("rays_closest") + count("rays_shadow"));
}

}  // namespace wavecrest
