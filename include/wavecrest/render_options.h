// What one may choose about a render: the options of `wavecrest render`, with the same names, words and defaults.
// Numbers outside of the ranges that its --help names are refused.
#pragma once

#include <cstdint>
#include <string>

namespace wavecrest::api {

struct RenderOptions {
  std::string method = "pt";  // pt, lt, bpt, mlt, ppm, bpm, vcm, gpt or evcm
  std::string time{};         // of rendering: "6s", "100ms", "1h30m"
  uint64_t spp = 0;  // iterations: paths, of mlt mutations, per pixel. Neither time nor spp: what the scene says
  uint64_t seed = 0;
  uint32_t threads = 0;          // 0: all cores
  std::string sampler = "auto";  // independent, sobol, or auto: sobol for pt, bpt and vcm
  std::string filterMode = "spread", precision = "float", isa = "auto", accel = "auto", instances = "auto";
  int maxDepth = 0;                     // edges of the longest path; -1: unlimited, 0: what the scene says
  int rrDepth = 0;                      // first vertex where roulette may end a path; 0: what the scene says
  std::string roulette = "efficiency";  // throughput, albedo or efficiency: what decides whether a walk goes on
  uint32_t wave = 2048;                 // paths per wave
  std::string memory{};                 // budget: "800M", "2GiB"; empty: none
  bool measureStages = false;           // stats have `stages` with the time of each, which costs some percent

  // ppm, bpm, vcm: the first radius of merges, relative to the bounding sphere's (0: auto, what the image needs), and
  // how slowly it shrinks.
  double radius = 0, radiusAlpha = 0.75;
  std::string mergeVertices = "first";  // vcm: camera paths merge at "all" vertices, or at the "first" alone
  uint64_t lightPaths = 0;              // of an iteration; 0: as many as pixels, of ppm and bpm at least 4096
  bool directPass = false;              // ppm: direct light by next event estimation
  // bpt, vcm: Russian roulette of connections whose contribution is below this share of a typical pixel's brightness.
  // 0: no roulette. Small scenes, whose shadow rays cost next to nothing, never use it.
  double connectionRoulette = 0.2;

  // gpt: what its guide is learned for: radiance, variance or off, or auto: radiance or off, whichever trials find
  // better; memory of what it learns (empty: 64MiB).
  std::string guide = "auto", guideMemory{};

  // mlt: pssmlt, mmlt or pathspace (empty: mmlt); Markov chains; independent samples from which they start; steps
  // before they start anew (0: by the number of samples); whether chains render direct light, too.
  std::string mlt{};
  uint32_t chains = 16384, bootstrap = 131072, restart = 0;
  bool noDirectPass = false;
};

}  // namespace wavecrest::api
