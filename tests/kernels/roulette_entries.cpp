// Roulette of connections behind plain pointers, for roulette_lanes_test.cpp.
#include "tests/kernels/roulette_entries.h"

#include "kernels/connect/roulette_lanes.h"
#include "kernels/simd/isa_table.h"

WAVECREST_SIMD_BEGIN
namespace {

float chance(float carried, float below) {
  HWY_ALIGN float out[kLanes];
  store(rouletteChance(Float(carried), Float(below)), out);
  return out[0];
}

uint64_t joined(float probability, uint32_t depth) {
  uint64_t count = 0;
  for (uint32_t i = 0; i < 1u << 24; i += kLanes) {
    const Float uniform = toFloat(laneIndex(i)) * Float(0x1p-24f);
    count += countTrue(rouletteNumber(uniform, UInt(depth)) < Float(probability));
  }
  return count;
}

constexpr RouletteEntries kEntries = {.lanes = kLanes, .chance = chance, .joined = joined};
WAVECREST_REGISTER_ENTRIES(RouletteEntries, kEntries);

}  // namespace
WAVECREST_SIMD_END
