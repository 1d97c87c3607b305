// dependentUniform4: random numbers of the kinds `sobol` and `chain`.
//
// One copy for each instruction set, which all stages call. in and out: those of uniform4 (random_lanes.h).
#include "kernels/sampling/chain_lanes.h"
#include "kernels/sampling/random_lanes.h"
#include "kernels/sampling/sobol_lanes.h"

WAVECREST_SIMD_BEGIN

Uniform4 dependentUniform4(const SamplerSettings& sampler, UInt path, uint32_t block, Stream stream) {
  if (sampler.kind == SamplerKind::chain) {
    const ChainNumbers numbers = chainNumbers(sampler, path, block, stream);
    const auto unit = [](UInt number) WAVECREST_LAMBDA { return toFloat(number) * Float(0x1p-24f); };
    return {unit(numbers.a), unit(numbers.b), unit(numbers.c), unit(numbers.d)};
  }
  if (block / 4 >= sobolVertices(stream)) return independentUniform4(sampler, path, block, stream);
  const SobolPoint bits =
      stream == Stream::light ? sharedSobolBits(sampler, path, block) : sobolBits(sampler, path, block, stream);
  return {toUnitInterval(bits.a), toUnitInterval(bits.b), toUnitInterval(bits.c), toUnitInterval(bits.d)};
}

WAVECREST_SIMD_END
