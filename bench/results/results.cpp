#include "bench/results/results.h"

#include <algorithm>

namespace wavecrest {

std::string_view toString(RunState state) { return state == RunState::done ? "done" : "refused"; }

void addDistinct(std::string& list, const std::string& value) {
  if (list.empty()) {
    list = value;
  } else if ((", " + list + ", ").find(", " + value + ", ") == std::string::npos) {
    list += ", " + value;
  }
}

const SceneRecord* CampaignResults::findScene(std::string_view name) const {
  const auto found = std::find_if(scenes.begin(), scenes.end(), [&](const SceneRecord& s) { return s.name == name; });
  return found == scenes.end() ? nullptr : &*found;
}

const RunRecord* CampaignResults::findRun(std::string_view scene, std::string_view method, uint64_t seed) const {
  const auto found = std::find_if(runs.begin(), runs.end(), [&](const RunRecord& run) {
    return run.scene == scene && run.method == method && run.seed == seed;
  });
  return found == runs.end() ? nullptr : &*found;
}

}  // namespace wavecrest
