#include "bench/report/series_facts.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "bench/report/html_text.h"
#include "bench/statistics/chains_mislead.h"

namespace wavecrest {
namespace {

constexpr const char* kSettingKeys[] = {
    "seed",           "sampler",      "precision",         "accel",         "specialization",   "wave", "scene_hash",
    "bytes_per_path", "load_seconds", "peak_memory_bytes", "build_seconds", "nonfinite_samples"};

std::string valueText(const nlohmann::json& value) {
  if (value.is_string()) return value.get<std::string>();
  return value.is_number_float() ? formatSignificant(value.get<double>()) : value.dump();
}

double number(const nlohmann::json& object, const char* key) {
  const auto entry = object.find(key);
  return entry != object.end() && entry->is_number() ? entry->get<double>() : 0;
}

}  // namespace

void addDistinct(std::vector<NamedValue>& shown, const std::vector<const nlohmann::json*>& objects, const char* key) {
  std::vector<std::string> values;
  for (const nlohmann::json* object : objects) {
    const auto entry = object->find(key);
    if (entry == object->end() || entry->is_null()) continue;
    const std::string text = valueText(*entry);
    if (std::find(values.begin(), values.end(), text) == values.end()) values.push_back(text);
  }
  if (!values.empty()) shown.push_back({key, fmt::format("{}", fmt::join(values, ", "))});
}

void addStage(std::vector<ReportStage>& sums, const ReportStage& stage) {
  auto sum = std::find_if(sums.begin(), sums.end(), [&](const ReportStage& known) { return known.name == stage.name; });
  if (sum == sums.end()) sum = sums.insert(sums.end(), {.name = stage.name});
  sum->items += stage.items;
  sum->seconds += stage.seconds;
}

void addSeriesFacts(ReportSeries& series, const std::vector<const nlohmann::json*>& stats) {
  for (const nlohmann::json* run : stats) {
    series.pathsPerSecond += number(*run, "paths_per_second") / static_cast<double>(stats.size());
    series.cpuSeconds += number(*run, "cpu_seconds");
  }
  for (const char* key : kSettingKeys) addDistinct(series.settings, stats, key);
}

void addChainsRemark(std::vector<std::string>& remarks, const ReportScene& scene) {
  const bool few = std::ranges::any_of(scene.series, [](const ReportSeries& series) {
    return series.method.starts_with("mlt") && series.runs.size() < kFewestChainRenders;
  });
  const std::string remark = fmt::format("Of mlt: {}.", kChainsMislead);
  if (few && std::ranges::find(remarks, remark) == remarks.end()) remarks.push_back(remark);
}

}  // namespace wavecrest
