// A SceneResult as JSON: every number in base units (seconds, counts per second, bytes).
#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "bench/enumerator_name.h"
#include "bench/throughput/bench_scene.h"

namespace wavecrest {
namespace {

using Json = nlohmann::ordered_json;

Json speedJson(const Speed& speed) {
  Json stages = Json::array(), scaling = Json::array();
  for (const StageShare& stage : speed.stages) {
    stages.push_back({{"name", stage.name},
                      {"items_per_path", stage.itemsPerPath},
                      {"seconds_per_item", 1e-9 * stage.nsPerItem},
                      {"seconds_per_path", 1e-9 * stage.nsPerPath},
                      {"share", stage.share},
                      {"lane_use", stage.laneUse ? Json(*stage.laneUse) : Json()}});
  }
  for (const ScalingRow& row : speed.scaling) {
    scaling.push_back({{"threads", row.threads},
                       {"paths_per_second", row.pathsPerSecond},
                       {"speedup", row.speedup},
                       {"cpu_efficiency", row.cpuEfficiency}});
  }
  return {{"isa", std::string(toString(speed.facts.isa))},
          {"specialization", enumeratorName(kSpecializationNames, speed.facts.specialization)},
          {"accel", enumeratorName(kAccelNames, speed.facts.accel)},
          {"paths_per_second", speed.pathsPerSecond},
          {"paths_per_cpu_second", speed.pathsPerCpuSecond},
          {"rays_per_path", speed.raysPerPath},
          {"rays_per_second", speed.raysPerSecond},
          {"rays_per_cpu_second", speed.raysPerCpuSecond},
          {"bytes_per_path", speed.bytesPerPath},
          {"stages", stages},
          {"rest_share", speed.restShare},
          {"scaling", scaling}};
}

Json ratesJson(const RayRates& rates) {
  return {{"rays", rates.rays},
          {"bare_rays_per_second", rates.bare},
          {"embree_stage_rays_per_second", rates.embreeStage},
          {"used_stage_rays_per_second", rates.usedStage}};
}

Json policiesJson(const PolicyTable& table) {
  Json rows = Json::array();
  for (const PolicyRow& row : table.rows) {
    rows.push_back({{"precision", enumeratorName(kPrecisionNames, row.precision)},
                    {"isa", std::string(toString(row.isa))},
                    {"specialization", enumeratorName(kSpecializationNames, row.specialization)},
                    {"paths_per_cpu_second", row.pathsPerCpuSecond},
                    {"mean_difference", row.meanDifference},
                    {"pixel_difference", row.pixelDifference},
                    {"bytes_per_path", row.bytesPerPath}});
  }
  return {{"iterations", table.iterations}, {"rows", rows}};
}

Json errorsJson(const std::vector<ErrorRow>& errors) {
  Json rows = Json::array();
  for (const ErrorRow& row : errors) {
    Json points = Json::array();
    for (const ErrorAtTime& at : row.points) {
      points.push_back({{"seconds", at.seconds},
                        {"cpu_seconds", at.cpuSeconds},
                        {"samples_per_pixel", at.samplesPerPixel},
                        {"relmse", at.relmse},
                        {"efficiency", at.efficiency}});
    }
    rows.push_back({{"method", std::string(toString(row.method))},
                    {"sampler", std::string(toString(row.sampler))},
                    {"points", points}});
  }
  return rows;
}

}  // namespace

Json toJson(const SceneResult& result) {
  Json methods = Json::array();
  for (const MethodResult& row : result.methods) {
    Json method = speedJson(row.speed);
    if (row.bareEmbree) {
      const BareEmbree& embree = *row.bareEmbree;
      method["bare_embree"] = {{"closest", ratesJson(embree.closest)},
                               {"any_hit", ratesJson(embree.anyHit)},
                               {"rays_per_second", embree.raysPerSecond()},
                               {"render_ratio", row.speed.raysPerCpuSecond / embree.raysPerSecond()}};
    }
    method["policies"] = policiesJson(row.policies);
    Json entry = {{"method", std::string(toString(row.method))}};
    entry.update(method);
    methods.push_back(entry);
  }
  return {{"scene", result.scene},
          {"scene_hash", fmt::format("{:016x}", result.hash)},
          {"width", result.width},
          {"height", result.height},
          {"threads", result.threads},
          {"methods", methods},
          {"reference", {{"seconds", result.reference.seconds}, {"relmse", result.reference.noise}}},
          {"errors", errorsJson(result.errors)}};
}

}  // namespace wavecrest
