#include "kernels/simd/isa.h"

#include <hwy/targets.h>

#include <stdexcept>

#include "compiled_isas.h"  // generated: kCompiledIsas, from WAVECREST_ISAS

namespace wavecrest {
namespace {

constexpr std::array<std::string_view, 4> kNames{"scalar", "sse4", "avx2", "avx512"};

bool cpuSupports(Isa isa) {
  const int64_t targets = hwy::SupportedTargets();
  switch (isa) {
    case Isa::scalar:
      return true;
    case Isa::sse4:
      return (targets & HWY_SSE4) != 0;
    case Isa::avx2:
      return (targets & HWY_AVX2) != 0;
    case Isa::avx512:
      return (targets & HWY_AVX3) != 0;
  }
  return false;
}

std::vector<Isa> findAvailable() {
  std::vector<Isa> available;
  for (const Isa isa : kAllIsas) {
    for (const std::string_view compiled : kCompiledIsas) {
      if (compiled == toString(isa) && cpuSupports(isa)) available.push_back(isa);
    }
  }
  if (available.empty()) throw std::runtime_error("this machine has none of the instruction sets of this build");
  return available;
}

}  // namespace

std::string_view toString(Isa isa) { return kNames[static_cast<size_t>(isa)]; }

const std::vector<Isa>& availableIsas() {
  static const std::vector<Isa> available = findAvailable();
  return available;
}

Isa bestIsa() { return availableIsas().back(); }

}  // namespace wavecrest
