// A SceneResult as JSON: every number in base units (seconds, counts per second, bytes).
#include <nlohmann/json.hpp>

#include "bench/enumerator_name.h"
#include "bench/estimate_json.h"
#include "bench/throughput/bench_scene.h"
#include "bench/throughput/doubts.h"
#include "engine/scene/hash_text.h"

namespace wavecrest {
namespace {

using Json = nlohmann::ordered_json;

// All slices of one thread count, each with the number of its visit.
Json slicesJson(const VisitSlices& visits) {
  Json rows = Json::array();
  for (size_t visit = 0; visit < visits.size(); ++visit) {
    for (const Slice& slice : visits[visit]) {
      rows.push_back(
          {{"visit", visit}, {"paths", slice.paths}, {"seconds", slice.seconds}, {"cpu_seconds", slice.cpuSeconds}});
    }
  }
  return rows;
}

// What else the machine did meanwhile. null: this system does not tell.
Json stateJson(const MachineState& state) {
  const auto orNull = [](const std::optional<double>& value) { return value ? Json(*value) : Json(); };
  return {{"seconds", state.seconds},
          {"others_cores", orNull(state.othersCores)},
          {"stolen_cores", orNull(state.stolenCores)},
          {"slowest_mhz", state.slowestMhz},
          {"fastest_mhz", state.fastestMhz}};
}

// lane_use is null for stages that do not work in blocks.
Json stageJson(const StageShare& stage) {
  Json row = {{"name", stage.name}, {"items_per_path", stage.itemsPerPath}};
  addEstimate(row, "seconds_per_item", stage.nsPerItem, 1e-9);
  addEstimate(row, "seconds_per_path", stage.nsPerPath, 1e-9);
  addEstimate(row, "share", stage.share);
  row["lane_use"] = stage.laneUse ? Json(*stage.laneUse) : Json();
  return row;
}

// One thread count. `bench --compare` reads its slices.
Json scalingJson(const ScalingRow& row) {
  Json json = {{"threads", row.threads}};
  addEstimate(json, "paths_per_second", row.pathsPerSecond);
  addEstimate(json, "speedup", row.speedup);
  addEstimate(json, "cpu_efficiency", row.cpuEfficiency);
  json["slices"] = slicesJson(row.slices);
  return json;
}

// Speed of one method, its stages, its growth with threads, and reasons for doubt.
Json speedJson(const Speed& speed) {
  Json json = {{"isa", std::string(toString(speed.facts.isa))},
               {"specialization", enumeratorName(kSpecializationNames, speed.facts.specialization)},
               {"accel", enumeratorName(kAccelNames, speed.facts.accel)}};
  addEstimate(json, "paths_per_second", speed.pathsPerSecond);
  addEstimate(json, "paths_per_cpu_second", speed.pathsPerCpuSecond);
  json["rays_per_path"] = speed.raysPerPath;
  addEstimate(json, "rays_per_second", speed.raysPerSecond);
  addEstimate(json, "rays_per_cpu_second", speed.raysPerCpuSecond);
  json["bytes_per_path"] = speed.bytesPerPath;
  json["stages"] = Json::array();
  for (const StageShare& stage : speed.stages) json["stages"].push_back(stageJson(stage));
  addEstimate(json, "rest_share", speed.restShare);
  json["scaling"] = Json::array();
  for (const ScalingRow& row : speed.scaling) json["scaling"].push_back(scalingJson(row));
  json["meanwhile"] = stateJson(speed.machine);
  json["doubts"] = doubtsAbout(speed);
  return json;
}

// Rays per second on one core.
Json ratesJson(const RayRates& rates) {
  return {{"rays", rates.rays},
          {"bare_rays_per_second", rates.bare},
          {"bare_not_robust_rays_per_second", rates.notRobust},
          {"embree_stage_rays_per_second", rates.embreeStage},
          {"used_stage_rays_per_second", rates.usedStage}};
}

// Differences are relative to the image of double precision. null: too few rounds for an interval.
Json policiesJson(const PolicyTable& table) {
  Json rows = Json::array();
  for (const PolicyRow& row : table.rows) {
    Json json = {{"precision", enumeratorName(kPrecisionNames, row.precision)},
                 {"isa", std::string(toString(row.isa))},
                 {"specialization", enumeratorName(kSpecializationNames, row.specialization)}};
    json["paths_per_cpu_second"] = row.pathsPerCpuSecond;
    const std::optional<Interval>& interval = row.pathsPerCpuSecondInterval;
    json["paths_per_cpu_second_interval"] = interval ? intervalJson(*interval) : Json();
    json["mean_difference"] = row.meanDifference;
    json["pixel_difference"] = row.pixelDifference;
    json["bytes_per_path"] = row.bytesPerPath;
    rows.push_back(json);
  }
  return {{"iterations", table.iterations}, {"rows", rows}};
}

// relMSE over time, for each method and sampler.
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
    // Methods with light paths or chains are not compared with bare Embree.
    if (row.bareEmbree) {
      const BareEmbree& embree = *row.bareEmbree;
      method["bare_embree"] = {{"closest", ratesJson(embree.closest)},
                               {"any_hit", ratesJson(embree.anyHit)},
                               {"rays_per_second", embree.raysPerSecond()},
                               {"render_ratio", row.speed.raysPerCpuSecond.value / embree.raysPerSecond()}};
    }
    method["policies"] = policiesJson(row.policies);
    // Objects keep the order of insertion: the method's name is to come first.
    Json entry = {{"method", std::string(toString(row.method))}};
    entry.update(method);
    methods.push_back(entry);
  }
  return {{"scene", result.scene},
          {"scene_hash", hashText(result.hash)},
          {"width", result.width},
          {"height", result.height},
          {"threads", result.threads},
          {"methods", methods},
          {"interval_level", kIntervalLevel},
          {"reference",
           {{"method", std::string(toString(result.reference.method))},
            {"biased", result.reference.biased},
            {"seconds", result.reference.seconds},
            {"relmse", result.reference.noise}}},
          {"errors", errorsJson(result.errors)}};
}

}  // namespace wavecrest
