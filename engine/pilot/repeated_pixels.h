// Pilots of small films visit pixels more than once. As a path follows from its pixel, each visit takes numbers of its
// own.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

namespace wavecrest {

// Where pixels stand for the first time, for the second time, and so on.
inline std::vector<std::vector<size_t>> visitsOf(std::span<const uint32_t> pixels) {
  std::vector<std::vector<size_t>> visits;
  std::unordered_map<uint32_t, size_t> earlier;
  for (size_t i = 0; i < pixels.size(); ++i) {
    const size_t visit = earlier[pixels[i]]++;
    if (visit == visits.size()) visits.emplace_back();
    visits[visit].push_back(i);
  }
  return visits;
}

}  // namespace wavecrest
