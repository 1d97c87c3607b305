#include "kernels/stages.h"

#include <cassert>
#include <stdexcept>
#include <string>

#include "compiled_isas.h"

namespace wavecrest {

// Defined by kernels/stage_table.cpp, once per compiled instruction set.
#define WAVECREST_DECLARE_TABLES(NAMESPACE) \
  namespace NAMESPACE {                     \
  const Stages<float>* floatStages();       \
  const Stages<double>* doubleStages();     \
  }
WAVECREST_DECLARE_TABLES(N_SCALAR)
WAVECREST_DECLARE_TABLES(N_SSE4)
WAVECREST_DECLARE_TABLES(N_AVX2)
WAVECREST_DECLARE_TABLES(N_AVX3)
#undef WAVECREST_DECLARE_TABLES

namespace {

struct Tables {
  const Stages<float>* floating;
  const Stages<double>* doubled;
};

Tables tablesOf(Isa isa) {
  switch (isa) {
#ifdef WAVECREST_ISA_SCALAR
    case Isa::scalar:
      return {N_SCALAR::floatStages(), N_SCALAR::doubleStages()};
#endif
#ifdef WAVECREST_ISA_SSE4
    case Isa::sse4:
      return {N_SSE4::floatStages(), N_SSE4::doubleStages()};
#endif
#ifdef WAVECREST_ISA_AVX2
    case Isa::avx2:
      return {N_AVX2::floatStages(), N_AVX2::doubleStages()};
#endif
#ifdef WAVECREST_ISA_AVX512
    case Isa::avx512:
      return {N_AVX3::floatStages(), N_AVX3::doubleStages()};
#endif
    default:
      throw std::invalid_argument("no kernels were compiled for " + std::string(toString(isa)));
  }
}

}  // namespace

template <>
const Stages<float>& findStages<float>(Isa isa, [[maybe_unused]] Precision precision, Specialization specialization) {
  assert(isCompiled(precision, specialization));
  return tablesOf(isa).floating[static_cast<size_t>(specialization)];
}

template <>
const Stages<double>& findStages<double>(Isa isa, [[maybe_unused]] Precision precision, Specialization specialization) {
  assert(isCompiled(precision, specialization));
  return tablesOf(isa).doubled[static_cast<size_t>(specialization)];
}

}  // namespace wavecrest
