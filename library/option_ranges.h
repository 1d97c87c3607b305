// The numbers that options take, for the command line and the library alike.
#pragma once

#include <cstdint>
#include <limits>

#include "kernels/sampling/sampler.h"
#include "kernels/scene_view.h"

namespace wavecrest {

// Both ends are in it.
template <class Number>
struct OptionRange {
  Number least, most;
};

// Renders. A depth may be -1 as well: unlimited.
constexpr OptionRange<uint64_t> kThreadRange{1, 4096};
constexpr OptionRange<int> kDepthRange{1, kMostEdges}, kRouletteDepthRange{1, std::numeric_limits<int>::max()};
constexpr OptionRange<uint64_t> kWaveRange{16, 1 << 20};
// Merging and connections.
constexpr OptionRange<double> kRadiusRange{1e-6, 10}, kRadiusAlphaRange{0, 1};
constexpr OptionRange<uint64_t> kLightPathRange{1, kMostPaths};
constexpr OptionRange<double> kConnectionRouletteRange{0, 100};
// Markov chains.
constexpr OptionRange<uint64_t> kChainRange{1, 1 << 24}, kBootstrapRange{1, 1 << 28}, kRestartRange{1, 1 << 24};
// Campaigns.
constexpr OptionRange<double> kTimeFactorRange{1e-4, 1e4};
// Exposure of 8-bit images.
constexpr OptionRange<double> kExposureRange{-100, 100};  // stops

}  // namespace wavecrest
