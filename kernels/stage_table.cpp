// The stages of this compilation's instruction set, for each precision and specialisation.
#include <utility>

#include "kernels/stage_declarations.h"
#include "kernels/stages.h"

WAVECREST_SIMD_BEGIN

namespace {

template <class P, uint32_t kFeatures>
constexpr Stages<typename P::Storage> makeStages() {
  Stages<typename P::Storage> stages{.isa = kIsa,
                                     .lanes = kLanes,
                                     .generateCameraPaths = generateCameraPaths<P, kFeatures>,
                                     .extendSmall = extendSmall<P>,
                                     .occludeSmall = occludeSmall<P>,
                                     .extendBvh = extendBvh<P>,
                                     .occludeBvh = occludeBvh<P>,
                                     .arrive = arrive<P, kFeatures>,
                                     .nextEvent = nextEvent<P, kFeatures>,
                                     .scatter = scatter<P, kFeatures>,
                                     .scatterSpecular = scatterSpecular<P, kFeatures>,
                                     .proposeMutations = proposeMutations<P>,
                                     .recordVertices = recordVertices<P>,
                                     .acceptMutations = acceptMutations<P>};
  if constexpr (has(kFeatures, kBidirectional)) {
    stages.generateLightPaths = generateLightPaths<P, kFeatures>;
    stages.storeLightVertices = storeLightVertices<P, kFeatures>;
    stages.connectToCamera = connectToCamera<P, kFeatures>;
    stages.connectVertices = connectVertices<P, kFeatures>;
    stages.merge = merge<P, kFeatures>;
    stages.admitWalks = admitWalks<P, kFeatures>;
    stages.takeEnds = takeEnds<P, kFeatures>;
    stages.proposePaths = proposePaths<P>;
    stages.beginEyeWalks = beginEyeWalks<P, kFeatures>;
    stages.beginLightWalks = beginLightWalks<P, kFeatures>;
    stages.recordMisses = recordMisses<P, kFeatures>;
    stages.recordPathVertices = recordPathVertices<P, kFeatures>;
    stages.walkPaths = walkPaths<P, kFeatures>;
    stages.joinPaths = joinPaths<P, kFeatures>;
    stages.evaluatePaths = evaluatePaths<P, kFeatures>;
    stages.weighPaths = weighPaths<P>;
    stages.commitPaths = commitPaths<P>;
  }
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
const Stages<float>* fastStages() { return kTable<FastPrecision>.data(); }
const Stages<double>* doubleStages() { return kTable<DoublePrecision>.data(); }

WAVECREST_SIMD_END
