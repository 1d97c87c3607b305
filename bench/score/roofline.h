// How near stages come to what a core can do: bytes that they move and time that they take, against the measured
// bandwidth of the cache that holds a wave, of memory, and the measured rate of arithmetic.
//
// Bytes are those of the wave's columns that a stage's contract names, each counted once: in full for what it reads,
// and in full for what it writes, although a stage that compacts writes less. What it reads of the scene, the photon
// map and the stores of light vertices is not in it. Operations are not counted by anything here: what is said instead
// is how many the stage's time would have sufficed for.
#pragma once

#include <optional>
#include <string_view>

#include "engine/plan/render_settings.h"
#include "engine/scene/scene.h"
#include "kernels/stage_catalogue.h"

namespace wavecrest {

// Of one thread.
struct Ceilings {
  double cacheBytesPerSecond = 0;   // triad over half of the second cache
  double memoryBytesPerSecond = 0;  // triad over several times the third; write-allocate traffic is not counted
  double operationsPerSecond = 0;   // additions and multiplications, fused
};

// Takes about half a second of CPU time.
Ceilings measureCeilings(Isa isa);

// Bytes per item of a stage by its row of the statistics, such as "extend light"; nothing for rows that are no stage of
// the catalogue, or whose stage keeps no contract with columns of the wave alone.
class StageTraffic {
 public:
  StageTraffic(const Scene& scene, const RenderSettings& settings);
  std::optional<size_t> bytesPerItem(std::string_view row) const;

 private:
  // Of a record of each queue.
  size_t rays_ = 0, hits_ = 0, surfaces_ = 0, paths_ = 0, shadowRays_ = 0, vertexRows_ = 0, radiance_ = 0;
};

}  // namespace wavecrest
