// Which random numbers a render uses, as plain data. The numbers themselves are drawn by
// kernels/sampling/random_lanes.h.
//
// Every number is a pure function of (seed, iteration, path, block, stream): nothing is stored between draws, so wave
// size, queue order, thread count and instruction set do not change what a path sees, and any path can be repeated
// alone.
//
// Lanes of one wave may be of kIterationsPerWave successive iterations: a lane's path word is its path plus how many
// iterations it is ahead of the sampler's, kPathBits higher. The words of all lanes then differ in one register, and
// everything else about a draw is the same for the whole wave.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace wavecrest {

constexpr uint32_t kPathBits = 28;
constexpr uint32_t kMostPaths = 1u << kPathBits;
constexpr uint32_t kIterationsPerWave = 1u << (32 - kPathBits);

// independent: every number is independent of every other.
// sobol: the numbers of one (path, block) are well distributed over the iterations. The light paths of an iteration are
//   points of one sequence: the numbers of a block are well distributed over paths and iterations.
// chain: what Markov chains propose (ChainSamples); no choice of the user's, but part of Metropolis light transport.
enum class SamplerKind { independent, sobol, chain };

// Those that a user may choose.
constexpr std::array<SamplerKind, 2> kAllSamplerKinds{SamplerKind::independent, SamplerKind::sobol};

// "independent" or "sobol": the spelling of --sampler.
constexpr std::string_view toString(SamplerKind kind) {
  constexpr std::array<std::string_view, 3> kNames{"independent", "sobol", "chain"};
  return kNames[static_cast<size_t>(kind)];
}

// What the numbers are for; paths of different streams share path indices but no numbers.
// filter: the place in the pixel that all samples of an iteration share (StageContext::sharedPlace).
// guide: of camera paths, whether the guide draws, its bin and the place in it (2).
enum class Stream : uint32_t { camera, light, bootstrap, chain, filter = 5, guide };

// Each vertex has four blocks of four numbers; this is the one table of their uses.
enum class Block : uint32_t {
  scatter = 0,  // lobe, direction (2), roulette; of a camera path's origin: raster (2), lens (2); of a light's: light,
                // direction (2), choice within the light; of stream filter: place in the pixel (2)
  light = 1,    // next event: light, choice within the light, position (2); of a light path's origin: position (2),
                // face of the scene's box; of a light path's other vertices: lens (2), pixel that a filter reaches (2);
                // of a caustic perturbation: angle
  opacity = 2,  // (a) which surfaces the edge to the vertex passes; (d) roulette of connections; of a multiplexed
                // camera path's origin: strategy
  environment = 3  // texel of the environment map (2), place within (2), of which the last also chooses sun or sky
};

// Which blocks of a walk's origin and of its other vertices a chain keeps: bit b stands for block b of the vertex.
// A stage may draw no others.
struct ChainBlocks {
  uint32_t origin = 0, vertex = 0;
};

// Random numbers of a wave of Markov chains, whose state is the numbers themselves (Kelemen et al. 2002). The sampler's
// iteration is the step; paths are lanes of the wave; a vertex is the path's origin or where its edges lead.
//
// A proposal is never stored: each of its numbers is a function of the current one and of (seed, source, step, block).
// Vertices before `live` are perturbed, later ones drawn afresh; a large step has live = 0. What the current path did
// not use is thus always fresh, which is no approximation: given the numbers that a path used, all others are uniform
// under the chain's target, so drawing them anew before each step leaves the target as it is, and only what was used
// needs to be kept, or rewritten on acceptance.
struct ChainSamples {
  uint32_t* values = nullptr;          // current numbers times 2^24, in the order (column, a to d, lane)
  const uint32_t* source = nullptr;    // per lane: the path that its random numbers are of
  const uint32_t* live[2]{};           // per walk and lane: how many vertices to perturb
  size_t stride = 0;                   // items from one row of lanes to the next
  ChainBlocks blocks[2];               // per walk
  uint32_t firstColumn[2]{};           // per walk
  Stream stream = Stream::chain;       // or bootstrap
  float largeStep = 0.3f;              // probability of a large step
  uint32_t stepBits = kChainStepBits;  // size of small steps; 0: no step at all

  // Bits of 2^14, the smallest step in units of 2^-24: steps are between 2^-10 and 2^-6 (Kelemen's s1 and s2).
  static constexpr uint32_t kChainStepBits = (127u + 14u) << 23;

  // Which column of `values` keeps a block; blocks count 4 to a vertex.
  uint32_t column(size_t walk, uint32_t block) const {
    const auto bitsBelow = [](uint32_t bits, uint32_t b) { return std::popcount(bits & ((1u << b) - 1)); };
    const uint32_t depth = block / 4, b = block % 4;
    const ChainBlocks& kept = blocks[walk];
    const int before = depth == 0
                           ? bitsBelow(kept.origin, b)
                           : std::popcount(kept.origin) + static_cast<int>(depth - 1) * std::popcount(kept.vertex) +
                                 bitsBelow(kept.vertex, b);
    return firstColumn[walk] + static_cast<uint32_t>(before);
  }
  bool keeps(size_t walk, uint32_t block) const {
    return ((block < 4 ? blocks[walk].origin : blocks[walk].vertex) >> (block % 4) & 1u) != 0;
  }
};

// A word of Philox's counter that tells streams apart, in its low byte, and every 2^32 iterations from the others.
constexpr uint32_t streamWord(uint32_t stream, uint64_t iteration) {
  return stream | static_cast<uint32_t>(iteration >> 32) << 8;
}

// The part of the arguments that one iteration shares.
struct SamplerSettings {
  SamplerKind kind = SamplerKind::independent;
  uint64_t seed = 0;
  uint64_t iteration = 0;               // if lanes are ahead of it, a multiple of the number of iterations in the wave
  const ChainSamples* chain = nullptr;  // of kind `chain`
  // Of kind `sobol`, for stream `light`: light paths of an iteration, which has no path beyond them. All are points of
  // one sequence, one after the other.
  uint64_t lightPaths = 0;
};

// How many vertices of a walk have numbers of kind `sobol`, its origin included. Where a path is after them depends on
// all numbers before: well distributed ones are worth no more there, and independent ones are cheaper.
constexpr uint32_t sobolVertices(Stream stream) { return stream == Stream::light ? 1 : 3; }

}  // namespace wavecrest
