// What every kernel test uses: a fixture that runs on each instruction set of this machine, and columns with sentinels.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstring>
#include <string>
#include <vector>

#include "kernels/simd/isa_table.h"

namespace wavecrest {

// Tests written with TEST_P(Suite, behaviour) run once per available instruction set.
class IsaTest : public testing::TestWithParam<Isa> {
 protected:
  template <class Entries>
  static const Entries& entries() {
    return IsaTable<Entries>::of(GetParam());
  }
  // The scalar twin: the oracle for all others.
  template <class Entries>
  static const Entries& twin() {
    return IsaTable<Entries>::of(Isa::scalar);
  }
};

// Test names end in the instruction set: EveryIsa/Suite.behaviour/avx2.
#define WAVECREST_TEST_EVERY_ISA(SUITE)                                         \
  INSTANTIATE_TEST_SUITE_P(EveryIsa, SUITE, testing::ValuesIn(availableIsas()), \
                           [](const auto& instance) { return std::string(toString(instance.param)); })

// count values of T, starting `offset` values past an aligned address, with sentinels before the first and after the
// last of `capacity` values. T must be trivially copyable.
template <class T>
class GuardedColumn {
 public:
  explicit GuardedColumn(size_t count, size_t capacity = 0, size_t offset = 0)
      : capacity_(std::max(count, capacity)),
        start_(kGuard + offset),
        bytes_((start_ + capacity_ + kGuard) * sizeof(T)) {
    blocks_.resize(bytes_ / sizeof(Block) + 1);
    std::memset(blocks_.data(), kSentinel, bytes_);
  }
  T* data() { return reinterpret_cast<T*>(blocks_.data()) + start_; }
  T& operator[](size_t i) { return data()[i]; }
  // Nothing outside of the capacity was written.
  bool intact() const {
    const auto* bytes = reinterpret_cast<const unsigned char*>(blocks_.data());
    for (size_t i = 0; i < bytes_; ++i) {
      const bool inside = i >= start_ * sizeof(T) && i < (start_ + capacity_) * sizeof(T);
      if (!inside && bytes[i] != kSentinel) return false;
    }
    return true;
  }

 private:
  struct alignas(64) Block {
    unsigned char bytes[64];
  };
  static constexpr size_t kGuard = 64 / sizeof(T) * 2;
  static constexpr unsigned char kSentinel = 0xA5;
  size_t capacity_, start_, bytes_;
  std::vector<Block> blocks_;
};

// Calls test(count, offset) for counts 0 to 2 * lanes + 1 and offsets 0 to 3: every tail, aligned and not.
template <class Test>
void forEachShape(size_t lanes, Test&& test) {
  for (size_t count = 0; count <= 2 * lanes + 1; ++count) {
    for (size_t offset = 0; offset < 4; ++offset) test(count, offset);
  }
}

}  // namespace wavecrest
