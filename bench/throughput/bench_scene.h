// Everything that `wavecrest bench` finds out about one scene, as plain data, and how it is shown.
#pragma once

#include <functional>
#include <memory>
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

// Measures one scene by several methods. Speed is measured in visits, so that several scenes can take turns and the
// drift of the machine shows in the intervals of each; all else comes once, at the end.
class SceneBench {
 public:
  // seconds: render time of all measurements of one method, about; the reference and the errors at equal time come once
  // per scene out of the first method's share. Keeps the scene.
  SceneBench(Scene scene, const RenderSettings& settings, const std::vector<Method>& methods, double seconds);

  // Measures the speed of every method once, in one of kVisitsForInterval parts of the time for it.
  void visit();
  // After all visits.
  SceneResult finish() const;

 private:
  RenderSettings settingsOf(Method method) const;

  std::unique_ptr<const Scene> scene_;  // where it was when measurements began
  RenderSettings settings_;
  std::vector<Method> methods_;
  double seconds_;
  std::vector<SpeedMeasurement> speeds_;  // by method
};

// Makes all visits, the scenes taking turns, and finishes the scenes one after the other, each with a call of done.
void benchInTurn(std::vector<SceneBench>& benches, const std::function<void(const SceneResult&)>& done);

// Tables for a terminal.
std::string toText(const SceneResult& result);
nlohmann::ordered_json toJson(const SceneResult& result);

}  // namespace wavecrest
