// Texture lookups behind a plain pointer, for texture_test.cpp.
#include "tests/kernels/texture_entries.h"

#include "kernels/simd/isa_table.h"
#include "kernels/surface/texture_lanes.h"

WAVECREST_SIMD_BEGIN
namespace {

constexpr TextureEntries kTextureEntries = {.evaluate = [](const TextureRecord* textures, const float* texels,
                                                           uint32_t id, const float* u, const float* v, float* value,
                                                           float* slopeU, float* slopeV) HWY_ATTR {
  for (size_t i = 0; i < TextureEntries::kMost; i += kLanes) {
    const Float atU = loadUnaligned(u + i), atV = loadUnaligned(v + i);
    storeUnaligned(evalTexture(textures, texels, UInt(id), atU, atV).x, value + i);
    const TextureSlopes slopes = textureSlopes(textures, texels, UInt(id), atU, atV);
    storeUnaligned(slopes.u, slopeU + i);
    storeUnaligned(slopes.v, slopeV + i);
  }
}};
WAVECREST_REGISTER_ENTRIES(TextureEntries, kTextureEntries);

}  // namespace
WAVECREST_SIMD_END
