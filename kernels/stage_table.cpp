// The stages of this compilation's instruction set, for each precision and specialisation.
#include <utility>

#include "kernels/stage_declarations.h"
#include "kernels/stages.h"

WAVECREST_SIMD_BEGIN

namespace {

template <class P, uint32_t kFeatures>
constexpr Stages<typename P::Storage> makeStages() {
  Stages<typename P::Storage> stages;
  stages.isa = kIsa;
  stages.lanes = kLanes;
  stages.addSplats = addSplats<typename P::Storage>;
  stages.spreadSamples = spreadSamples<typename P::Storage>;
  stages.filterPlaces = filterPlaces<typename P::Storage>;
#define WAVECREST_ENTER_featured(NAME) stages.NAME = NAME<P, kFeatures>;
#define WAVECREST_ENTER_bidirectional(NAME) \
  if constexpr (has(kFeatures, kBidirectional)) stages.NAME = NAME<P, kFeatures>;
#define WAVECREST_ENTER_common(NAME) stages.NAME = NAME<P>;
#define WAVECREST_ENTER(NAME, TITLE, ITEMS, FAMILY, LANES) WAVECREST_ENTER_##FAMILY(NAME)
  WAVECREST_STAGE_CATALOGUE(WAVECREST_ENTER)
#undef WAVECREST_ENTER
  return stages;
}

// An empty entry for what is not instantiated.
template <class P, Specialization kSpecialization>
constexpr Stages<typename P::Storage> makeStagesIfCompiled() {
  if constexpr (isCompiled(P::kPrecision, kSpecialization)) {
    return makeStages<P, featuresOf(kSpecialization)>();
  } else {
    return {};
  }
}

template <class P, size_t... kIndex>
constexpr std::array<Stages<typename P::Storage>, kSpecializationCount> makeTable(std::index_sequence<kIndex...>) {
  return {makeStagesIfCompiled<P, static_cast<Specialization>(kIndex)>()...};
}

template <class P>
constexpr auto kTable = makeTable<P>(std::make_index_sequence<kSpecializationCount>());

}  // namespace

const Stages<float>* floatStages() { return kTable<FloatPrecision>.data(); }
const Stages<double>* doubleStages() { return kTable<DoublePrecision>.data(); }

WAVECREST_SIMD_END
