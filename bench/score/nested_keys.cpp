#include "bench/score/nested_keys.h"

#include <algorithm>

namespace wavecrest {

void forEachNested(const nlohmann::json& objects, size_t levels,
                   const std::function<void(const std::string& key, const nlohmann::json& value)>& take) {
  for (const auto& [name, value] : objects.items()) {
    if (levels == 1) {
      take(name, value);
      continue;
    }
    const std::string& outer = name;
    forEachNested(value, levels - 1,
                  [&](const std::string& inner, const nlohmann::json& leaf) { take(outer + "/" + inner, leaf); });
  }
}

nlohmann::ordered_json& nestedPlace(nlohmann::ordered_json& objects, const std::string& key) {
  nlohmann::ordered_json* place = &objects;
  for (size_t begin = 0; begin <= key.size();) {
    const size_t end = std::min(key.find('/', begin), key.size());
    place = &(*place)[key.substr(begin, end - begin)];
    begin = end + 1;
  }
  return *place;
}

}  // namespace wavecrest
