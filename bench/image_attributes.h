// The string attributes by which the program's EXR files say how they were made: keys of `render --stats`, or fields of
// a reference, after a prefix of their own.
#pragma once

#include <string>
#include <string_view>

#include "metrics/image/image_io.h"

namespace wavecrest {

constexpr std::string_view kAttributePrefix = "wavecrest:";
// Begins the keys of a reference's noise floors, before the names of their scores.
constexpr std::string_view kNoiseFloorKey = "noise_floor.";

inline std::string attributeName(std::string_view key) { return std::string(kAttributePrefix).append(key); }

// Null where the file does not have it.
inline const std::string* findAttribute(const Metadata& metadata, std::string_view key) {
  const auto entry = metadata.find(attributeName(key));
  return entry == metadata.end() ? nullptr : &entry->second;
}

// Empty where the file does not have it.
inline std::string attributeOf(const Metadata& metadata, std::string_view key) {
  const std::string* const value = findAttribute(metadata, key);
  return value == nullptr ? std::string() : *value;
}

}  // namespace wavecrest
