// Elementary functions and warps: the time per value or point.
#include <random>

#include "bench/micro/isa_bench.h"
#include "bench/micro/lanes_bench.h"
#include "tests/kernels/math_entries.h"
#include "tests/kernels/warp_entries.h"

namespace wavecrest {
namespace {

// Numbers in (0,1): in the domain of every function.
template <class T>
std::vector<T> unitNumbers(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<T> uniform(T(0.01), T(0.99));
  std::vector<T> numbers(kItems);
  for (T& x : numbers) x = uniform(random);
  return numbers;
}

template <class T>
std::span<const MathFunction<T>> functionsOf(Isa isa) {
  const MathEntries& entries = IsaTable<MathEntries>::of(isa);
  if constexpr (sizeof(T) == 4) {
    return entries.floats;
  } else {
    return entries.doubles;
  }
}

template <class T>
void function(benchmark::State& state, Isa isa, size_t index) {
  const std::vector<T> a = unitNumbers<T>(1), b = unitNumbers<T>(2);
  std::vector<T> out(kItems), twin(kItems);
  const MathFunction<T> measured = functionsOf<T>(isa)[index];
  functionsOf<T>(Isa::scalar)[index].run(a.data(), b.data(), twin.data(), kItems);
  measured.run(a.data(), b.data(), out.data(), kItems);
  // Each is within its stated error of the truth (tests/kernels/math_test.cpp).
  if (!checkAgainstTwin(state, out, twin, 256 * std::numeric_limits<T>::epsilon())) return;
  for (auto _ : state) {
    measured.run(a.data(), b.data(), out.data(), kItems);
    benchmark::ClobberMemory();
  }
  reportItems(state, IsaTable<MathEntries>::of(isa).lanes);
}

template <class T>
void warp(benchmark::State& state, Isa isa, Warp<T> measured, Warp<T> twinWarp) {
  const std::vector<T> u = unitNumbers<T>(1), v = unitNumbers<T>(2);
  std::vector<T> x(kItems), y(kItems), z(kItems), pdf(kItems), twin(kItems);
  const auto run = [&](Warp<T> w) { w(u.data(), v.data(), T(0.3), x.data(), y.data(), z.data(), pdf.data(), kItems); };
  run(twinWarp);
  twin = x;
  run(measured);
  if (!checkAgainstTwin(state, x, twin, 4096 * std::numeric_limits<T>::epsilon())) return;
  for (auto _ : state) {
    run(measured);
    benchmark::ClobberMemory();
  }
  reportItems(state, IsaTable<WarpEntries>::of(isa).lanes);
}

// Every instruction set lists the same functions.
template <class T>
void registerFunctions(const std::string& type) {
  const auto functions = functionsOf<T>(Isa::scalar);
  for (size_t i = 0; i < functions.size(); ++i) {
    registerForEveryIsa("math/" + type + '/' + functions[i].name,
                        [i](benchmark::State& state, Isa isa) { function<T>(state, isa, i); });
  }
}

template <class T>
void registerWarps(const std::string& type, WarpFunctions<T> WarpEntries::*functions) {
  const auto add = [&](const char* name, Warp<T> WarpFunctions<T>::*member) {
    registerForEveryIsa("warp/" + type + '/' + name, [=](benchmark::State& state, Isa isa) {
      warp<T>(state, isa, (IsaTable<WarpEntries>::of(isa).*functions).*member,
              (IsaTable<WarpEntries>::of(Isa::scalar).*functions).*member);
    });
  };
  add("concentricDisc", &WarpFunctions<T>::concentricDisc);
  add("cosineHemisphere", &WarpFunctions<T>::cosineHemisphere);
  add("uniformSphere", &WarpFunctions<T>::uniformSphere);
  add("uniformCone", &WarpFunctions<T>::uniformCone);
  add("uniformTriangle", &WarpFunctions<T>::uniformTriangle);
}

}  // namespace

void registerMathBenchmarks() {
  registerFunctions<float>("float");
  registerFunctions<double>("double");
  registerWarps<float>("float", &WarpEntries::floats);
  registerWarps<double>("double", &WarpEntries::doubles);
}

}  // namespace wavecrest
