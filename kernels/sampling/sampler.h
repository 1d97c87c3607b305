// Which random numbers a render uses, as plain data. The numbers themselves are drawn by
// kernels/sampling/random_lanes.h.
//
// Every number is a pure function of (seed, iteration, path, block, stream): nothing is stored between draws, so wave
// size, queue order, thread count and instruction set do not change what a path sees, and any path can be repeated
// alone.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace wavecrest {

// independent: every number is independent of every other.
// sobol: the numbers of one (path, block) are well distributed over the iterations.
enum class SamplerKind { independent, sobol };

constexpr std::array<SamplerKind, 2> kAllSamplerKinds{SamplerKind::independent, SamplerKind::sobol};

// "independent" or "sobol": the spelling of --sampler.
constexpr std::string_view toString(SamplerKind kind) {
  return kind == SamplerKind::independent ? "independent" : "sobol";
}

// The inverse of toString; nothing for any other word.
constexpr std::optional<SamplerKind> parseSamplerKind(std::string_view word) {
  for (const SamplerKind kind : kAllSamplerKinds) {
    if (word == toString(kind)) return kind;
  }
  return std::nullopt;
}

// What the numbers are for; paths of different streams share path indices but no numbers.
enum class Stream : uint32_t { camera, light, bootstrap, chain, scene };

// The part of the arguments that one iteration shares.
struct SamplerSettings {
  SamplerKind kind = SamplerKind::independent;
  uint64_t seed = 0;
  uint32_t iteration = 0;
};

}  // namespace wavecrest
