// JSON as text, for values that hold names from outside.
//
// JSON is UTF-8, but names of files and scenes may be any bytes. Bytes that are no UTF-8 become U+FFFD, so that a name
// never keeps what belongs to it from being written.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace wavecrest {

// indent: spaces of each level; -1: all in one line.
template <class Json>
std::string jsonText(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

// Whether JSON can hold the text as it is.
inline bool isUtf8(const std::string& text) {
  const nlohmann::json json = text;
  return nlohmann::json::parse(jsonText(json)) == json;
}

}  // namespace wavecrest
