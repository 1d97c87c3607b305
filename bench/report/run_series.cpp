#include "bench/report/run_series.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "bench/image_attributes.h"
#include "bench/report/html_text.h"

namespace wavecrest {
namespace {

// Settings of the stats that make another series of a method; a dot leads into an object. Runs that agree in all of
// them differ by their seeds.
constexpr const char* kSeriesSettings[] = {"sampler",
                                           "precision",
                                           "filter_mode",
                                           "max_depth",
                                           "rr_depth",
                                           "roulette",
                                           "mlt",
                                           "chains",
                                           "bootstrap",
                                           "restart",
                                           "guide.target",
                                           "direct_pass",
                                           "radius",
                                           "radius_alpha",
                                           "light_paths_per_iteration",
                                           "merge_vertices",
                                           "connection_roulette"};

// Where stats have a setting.
nlohmann::json::json_pointer placeOf(const std::string& name) {
  std::string path = "/" + name;
  std::ranges::replace(path, '.', '/');
  return nlohmann::json::json_pointer(path);
}

// What a run's stats say of a setting; null where they do not.
nlohmann::json settingOf(const RunFile& run, const std::string& name) {
  const nlohmann::json::json_pointer place = placeOf(name);
  if (!run.stats.contains(place)) return {};
  nlohmann::json value = run.stats.at(place);
  // Without a limit earlier versions said 4095 of every method, where today's say 64 of mlt, and 2^24 of pt and gpt.
  if (name == "max_depth" && value.is_number_unsigned()) {
    value = std::min<uint64_t>(value.get<uint64_t>(), run.method == "mlt" ? 64 : 4095);
  }
  return value;
}

bool isSameSeries(const RunFile& a, const RunFile& b) {
  return a.method == b.method && std::ranges::all_of(kSeriesSettings, [&](const char* name) {
           return settingOf(a, name) == settingOf(b, name);
         });
}

// Throws if a run has the seed of another one of its series.
void requireOtherSeeds(const std::vector<RunFile*>& series, const RunFile& run) {
  const auto same = std::ranges::find(series, run.seed, &RunFile::seed);
  if (same == series.end()) return;
  throw ResultsError(
      fmt::format("{}: has the seed {} and the settings of {}; expected a render with another --seed, or "
                  "one of the two in another folder",
                  run.path.string(), run.seed, (*same)->path.string()));
}

// Measured times of seeds differ a little. Up to this factor they count as one time.
constexpr double kSameTime = 1.1;

// Whether snapshots of two seeds are of about the same time, or of equally many iterations.
bool meet(const SnapshotFile& a, const SnapshotFile& b) {
  const bool sameTime = std::max(a.seconds, b.seconds) <= kSameTime * std::min(a.seconds, b.seconds);
  return sameTime || (a.iterations > 0 && a.iterations == b.iterations);
}

// Whether the snapshots of each number meet.
bool meetByNumber(const std::vector<RunFile*>& runs) {
  std::map<unsigned, const SnapshotFile*> first;  // by number
  for (const RunFile* run : runs) {
    for (const SnapshotFile& snapshot : run->snapshots) {
      if (!meet(*first.try_emplace(snapshot.number, &snapshot).first->second, snapshot)) return false;
    }
  }
  return true;
}

// Numbers the snapshots of all runs of a series by time.
void numberByTime(const std::vector<RunFile*>& runs) {
  std::vector<std::pair<const RunFile*, SnapshotFile*>> order;
  for (RunFile* run : runs) {
    for (SnapshotFile& snapshot : run->snapshots) order.emplace_back(run, &snapshot);
  }
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.second->seconds < b.second->seconds; });
  unsigned number = 0;
  double first = 0;
  std::vector<const RunFile*> met;  // runs with a snapshot of this number
  for (const auto& [run, snapshot] : order) {
    const bool again = std::find(met.begin(), met.end(), run) != met.end();
    if (again || (!met.empty() && snapshot->seconds > kSameTime * first)) {
      ++number;
      met.clear();
    }
    if (met.empty()) first = snapshot->seconds;
    met.push_back(run);
    snapshot->number = number;
  }
}

}  // namespace

nlohmann::json seriesSettings(const Metadata& metadata) {
  nlohmann::json stats = nlohmann::json::object();
  for (const char* name : kSeriesSettings) {
    const std::string* const text = findAttribute(metadata, name);
    if (text == nullptr) continue;
    // Words stand without quotes.
    const nlohmann::json value = nlohmann::json::parse(*text, nullptr, false);
    stats[placeOf(name)] = value.is_discarded() ? nlohmann::json(*text) : value;
  }
  return stats;
}

std::vector<std::vector<RunFile*>> groupBySettings(const std::vector<RunFile*>& runs) {
  std::vector<std::vector<RunFile*>> groups;
  for (RunFile* run : runs) {
    const auto group =
        std::ranges::find_if(groups, [&](const auto& known) { return isSameSeries(*known.front(), *run); });
    if (group == groups.end()) {
      groups.push_back({run});
    } else {
      requireOtherSeeds(*group, *run);
      group->push_back(run);
    }
  }
  return groups;
}

std::string seriesLabel(const std::vector<std::vector<RunFile*>>& groups, const RunFile& run) {
  std::string label = run.method;
  for (const char* name : kSeriesSettings) {
    const nlohmann::json own = settingOf(run, name);
    const bool differs = std::ranges::any_of(groups, [&](const auto& group) {
      return group.front()->method == run.method && settingOf(*group.front(), name) != own;
    });
    if (!differs) continue;
    std::string words = name;
    std::ranges::replace(words, '_', ' ');
    if (own.is_string()) {
      label += " " + own.get<std::string>();
    } else if (own.is_number_integer()) {
      label += fmt::format(" {} {}", words, own.get<int64_t>());
    } else if (own.is_number()) {
      label += fmt::format(" {} {:g}", words, own.get<double>());
    } else if (own.is_boolean()) {
      label += (own.get<bool>() ? " " : " no ") + words;
    }
  }
  return label;
}

void numberSnapshots(const std::vector<RunFile*>& series) {
  if (series.front()->other || !meetByNumber(series)) numberByTime(series);
}

std::string remarkOnEnds(const std::vector<RunFile*>& series, const std::string& label) {
  const auto sooner = [](const RunFile* a, const RunFile* b) {
    return a->snapshots.back().seconds < b->snapshots.back().seconds;
  };
  const auto [first, last] = std::ranges::minmax_element(series, sooner);
  const SnapshotFile &begin = (*first)->snapshots.back(), &end = (*last)->snapshots.back();
  if (meet(begin, end)) return "";
  return fmt::format("{}: runs of {} end after {} to {}; scores at the end are means over all of them.",
                     (*first)->scene, label, formatSeconds(begin.seconds), formatSeconds(end.seconds));
}

}  // namespace wavecrest
