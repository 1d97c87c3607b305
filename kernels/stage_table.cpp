// The stages of this compilation's instruction set, for each precision and specialisation.
#include "kernels/stage_declarations.h"
#include "kernels/stages.h"

WAVECREST_SIMD_BEGIN

namespace {

constexpr Isa kThisIsa = HWY_TARGET == HWY_AVX3   ? Isa::avx512
                         : HWY_TARGET == HWY_AVX2 ? Isa::avx2
                         : HWY_TARGET == HWY_SSE4 ? Isa::sse4
                                                  : Isa::scalar;

template <class P, uint32_t kFeatures>
constexpr Stages<typename P::Storage> makeStages() {
  return {.isa = kThisIsa,
          .lanes = kLanes,
          .generateCameraPaths = generateCameraPaths<P, kFeatures>,
          .extendSmall = extendSmall<P, kFeatures>,
          .occludeSmall = occludeSmall<P, kFeatures>,
          .arrive = arrive<P, kFeatures>,
          .nextEvent = nextEvent<P, kFeatures>,
          .scatter = scatter<P, kFeatures>};
}

template <class P>
constexpr Stages<typename P::Storage> kTable[] = {makeStages<P, kSpecializationFeatures[0]>(),
                                                  makeStages<P, kSpecializationFeatures[1]>(),
                                                  makeStages<P, kSpecializationFeatures[2]>()};

}  // namespace

const Stages<float>* floatStages() { return kTable<FloatPrecision>; }
const Stages<float>* fastStages() { return kTable<FastPrecision>; }
const Stages<double>* doubleStages() { return kTable<DoublePrecision>; }

WAVECREST_SIMD_END
