#include "bench/checkpoint/merged_stats.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/stats_rates.h"
#include "engine/session/session.h"

namespace wavecrest {
namespace {

using Json = nlohmann::ordered_json;
using Keys = std::span<const std::string_view>;
// The values of one key, one of each part; null pointers where a part does not have it.
using Values = std::vector<const Json*>;

constexpr std::string_view kOfParts = "of_parts", kStepsEnd = "_steps", kAcceptanceEnd = "_acceptance";

// Counts and seconds. Counts of steps by kind of mutation end with kStepsEnd.
constexpr std::array<std::string_view, 24> kSums{
    "camera_paths",   "light_paths",  "mutations",     "rays_closest",      "rays_shadow",         "connections",
    "merges",         "load_seconds", "build_seconds", "render_seconds",    "render_wall_seconds", "wall_seconds",
    "cpu_seconds",    "parts",        "close_pairs",   "nonfinite_samples", "saturated_splats",    "paths_cut",
    "throughput_cut", "cut_energy",   "direct_paths",  "dark_proposals",    "stuck_runs",          "chain_bytes"};
// Keys of which the largest value is kept: memory of one process, counts of one chain.
constexpr std::array<std::string_view, 4> kLargest{"peak_memory_bytes", "light_bytes", "longest_rejection",
                                                   "bootstrap_epochs"};
// Keys that describe one part only, or that the caller or setRates() sets.
constexpr std::array<std::string_view, 9> kNotJoined{"part",           "first_iteration",  "resumed_from",
                                                     "relative_error", "missing",          kOfParts,
                                                     "iterations",     "paths_per_second", "rays_per_second"};

bool lists(Keys keys, std::string_view key) { return std::find(keys.begin(), keys.end(), key) != keys.end(); }
bool isSummed(std::string_view key) { return lists(kSums, key) || key.ends_with(kStepsEnd); }

// Whole where both are whole.
Json sumOf(const Json& a, const Json& b) {
  if (a.is_number_float() || b.is_number_float()) return a.get<double>() + b.get<double>();
  return a.get<uint64_t>() + b.get<uint64_t>();
}

template <class Join>
Json folded(const Values& values, Join join) {
  Json all = *values.front();
  for (size_t i = 1; i < values.size(); ++i) all = join(all, *values[i]);
  return all;
}

// The count of steps that an acceptance is a share of; empty of any other key.
std::string stepsOfAcceptance(const std::string& key) {
  if (!key.ends_with(kAcceptanceEnd)) return {};
  return key.substr(0, key.size() - kAcceptanceEnd.size()) + std::string(kStepsEnd);
}

// Accepted over proposed, from what each part accepted of its own proposals.
Json acceptanceOf(const std::string& key, std::span<const Json> parts) {
  double accepted = 0, proposed = 0;
  for (const Json& part : parts) {
    const auto steps = part.at(stepsOfAcceptance(key)).get<double>();
    accepted += part.at(key).get<double>() * steps;
    proposed += steps;
  }
  return proposed > 0 ? accepted / proposed : 0.0;
}

// Lists of texts without repetition.
Json unionOf(const Json& a, const Json& b) {
  Json all = a;
  for (const Json& text : b) {
    if (std::find(all.begin(), all.end(), text) == all.end()) all.push_back(text);
  }
  return all;
}

// Chains of all parts that rejected most proposals in a row.
Json mostStuck(const Json& a, const Json& b) {
  std::vector<Json> all(a.begin(), a.end());
  all.insert(all.end(), b.begin(), b.end());
  std::stable_sort(all.begin(), all.end(), [](const Json& x, const Json& y) {
    return x.at("rejections").get<uint64_t>() > y.at("rejections").get<uint64_t>();
  });
  if (all.size() > kListedStuckChains) all.resize(kListedStuckChains);
  return all;
}

// The rows of both, added up by position. Nothing where they are of other stages.
std::optional<Json> sumOfStages(const Values& values) {
  Json all = *values.front();
  for (size_t i = 1; i < values.size(); ++i) {
    const Json& more = *values[i];
    if (more.size() != all.size()) return std::nullopt;
    for (size_t row = 0; row < all.size(); ++row) {
      Json& sum = all.at(row);
      const Json& stage = more.at(row);
      if (stage.at("name") != sum.at("name")) return std::nullopt;
      for (const char* key : {"items", "seconds"}) sum[key] = sumOf(sum.at(key), stage.at(key));
    }
  }
  return all;
}

// Every part made the same trials. Nothing where they found something else.
std::optional<Json> sumOfChoices(const Values& values) {
  Json all = *values.front();
  for (size_t i = 1; i < values.size(); ++i) {
    Json more = *values[i];
    all["seconds"] = sumOf(all.at("seconds"), more.at("seconds"));
    more["seconds"] = all.at("seconds");
    if (more != all) return std::nullopt;
  }
  return all;
}

// What all parts together have of a key that each of them has. Nothing where that cannot be told.
std::optional<Json> joinedValue(const std::string& key, const Values& values, std::span<const Json> parts) {
  const auto all = [&](bool (Json::*is)() const noexcept) {
    return std::all_of(values.begin(), values.end(), [is](const Json* value) { return (value->*is)(); });
  };
  if (all(&Json::is_number)) {
    if (isSummed(key)) return folded(values, sumOf);
    if (lists(kLargest, key)) return folded(values, [](const Json& a, const Json& b) { return std::max(a, b); });
    if (parts.front().contains(stepsOfAcceptance(key))) return acceptanceOf(key, parts);
  } else if (all(&Json::is_array)) {
    if (key == "snapshots") return Json::array();
    if (key == "notes") return folded(values, unionOf);
    if (key == "stuck_chains") return folded(values, mostStuck);
    if (key == "stages") {
      if (const std::optional<Json> stages = sumOfStages(values)) return stages;
    }
  } else if (key == "choice") {
    if (const std::optional<Json> choice = sumOfChoices(values)) return choice;
  }
  const bool equal =
      std::all_of(values.begin(), values.end(), [&](const Json* value) { return *value == *values.front(); });
  return equal ? std::optional(*values.front()) : std::nullopt;
}

// The values of a key in all parts, with those of parts that are sums themselves. null: a part does not have it.
Json listOf(const std::string& key, std::span<const Json> parts) {
  Json all = Json::array();
  for (const Json& part : parts) {
    const auto inner = part.find(kOfParts);
    if (inner != part.end() && inner->contains(key)) {
      for (const Json& value : inner->at(key)) all.push_back(value);
    } else {
      all.push_back(part.contains(key) ? part.at(key) : Json());
    }
  }
  return all;
}

// All keys of the parts, in the order in which the parts have them.
std::vector<std::string> keysOf(std::span<const Json> parts) {
  std::vector<std::string> keys;
  const auto add = [&](const Json& object) {
    for (const auto& [key, value] : object.items()) {
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
    }
  };
  for (const Json& part : parts) {
    add(part);
    if (part.contains(kOfParts)) add(part.at(kOfParts));
  }
  return keys;
}

}  // namespace

Json mergedStats(std::span<const Json> parts) {
  if (parts.size() == 1) return parts.front();
  Json sum = Json::object(), ofParts = Json::object();
  for (const std::string& key : keysOf(parts)) {
    if (lists(kNotJoined, key)) continue;
    Values values;
    for (const Json& part : parts) {
      if (part.contains(key)) values.push_back(&part.at(key));
    }
    std::optional<Json> value;
    if (values.size() == parts.size()) value = joinedValue(key, values, parts);
    if (value) {
      sum[key] = std::move(*value);
    } else {
      ofParts[key] = listOf(key, parts);
    }
  }
  if (sum.contains("render_seconds")) setRates(sum);  // checkpoints of campaigns keep no statistics
  if (!ofParts.empty()) sum[std::string(kOfParts)] = std::move(ofParts);
  return sum;
}

}  // namespace wavecrest
