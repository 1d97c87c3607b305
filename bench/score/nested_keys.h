// Tables in the JSON files of the score: objects within objects, which are read into maps with keys A/B/C.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

namespace wavecrest {

// Calls `take` with the key and the value of everything that is `levels` objects deep.
void forEachNested(const nlohmann::json& objects, size_t levels,
                   const std::function<void(const std::string& key, const nlohmann::json& value)>& take);

// The place of a key in such a table, made where it is missing.
nlohmann::ordered_json& nestedPlace(nlohmann::ordered_json& objects, const std::string& key);

}  // namespace wavecrest
