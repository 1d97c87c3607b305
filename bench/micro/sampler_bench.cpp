// Random numbers: the time of uniform4, four numbers per path, of both samplers.
#include "bench/micro/isa_bench.h"
#include "bench/micro/lanes_bench.h"
#include "tests/kernels/sampler_entries.h"

namespace wavecrest {
namespace {

// Four columns one after the other.
void fill(const SamplerEntries& entries, SamplerKind kind, uint32_t iteration, std::vector<float>& columns) {
  float* first = columns.data();
  entries.fill({.kind = kind, .seed = 1, .iteration = iteration}, 0, 5, Stream::camera, kItems,
               {first, first + kItems, first + 2 * kItems, first + 3 * kItems});
}

void uniform4(benchmark::State& state, Isa isa, SamplerKind kind) {
  const SamplerEntries& entries = IsaTable<SamplerEntries>::of(isa);
  std::vector<float> columns(4 * kItems), twin(4 * kItems);
  fill(entries, kind, 3, columns);
  fill(IsaTable<SamplerEntries>::of(Isa::scalar), kind, 3, twin);
  if (!checkAgainstTwin(state, columns, twin, 0.0f)) return;

  uint32_t iteration = 0;
  for (auto _ : state) {
    fill(entries, kind, ++iteration, columns);
    benchmark::ClobberMemory();
  }
  reportItems(state, entries.lanes);
}

}  // namespace

void registerSamplerBenchmarks() {
  for (const SamplerKind kind : kAllSamplerKinds) {
    registerForEveryIsa("uniform4/" + std::string(toString(kind)),
                        [kind](benchmark::State& state, Isa isa) { uniform4(state, isa, kind); });
  }
}

}  // namespace wavecrest
