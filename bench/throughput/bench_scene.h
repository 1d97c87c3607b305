// Everything that `wavecrest bench` finds out about one scene, as plain data, and how it is shown.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "bench/throughput/bare_embree.h"
#include "bench/throughput/equal_time.h"
#include "bench/throughput/policies.h"
#include "bench/throughput/speed.h"

namespace wavecrest {

struct MethodResult {
  Method method{};
  Speed speed;
  std::optional<BareEmbree> bareEmbree;  // where it can be measured
  PolicyTable policies;
};

struct SceneResult {
  std::string scene;
  uint64_t hash = 0;
  uint32_t width = 0, height = 0, threads = 0;
  NoisyReference reference;
  std::vector<MethodResult> methods;
  std::vector<ErrorRow> errors;
};

// seconds: render time of all measurements of one method, about; the reference and the errors at equal time come once
// per scene out of the first method's share.
SceneResult benchScene(const Scene& scene, const RenderSettings& settings, const std::vector<Method>& methods,
                       double seconds);

// Tables for a terminal.
std::string toText(const SceneResult& result);
nlohmann::ordered_json toJson(const SceneResult& result);

}  // namespace wavecrest
