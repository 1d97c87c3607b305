// Many records in one block of memory: not initialised when it is made, so that threads may fill it side by side, and
// on large pages where it fills one, so that gathers miss fewer address translations.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "kernels/columns/memory_block.h"

namespace wavecrest {

// The most records that lanes can index: they count the 32-bit words of records in 32 bits with a sign (RecordLanes in
// kernels/lane_support.h).
template <class Record>
constexpr size_t kMostIndexed = (size_t{1} << 31) / (sizeof(Record) / sizeof(uint32_t));

template <class Record>
class RecordArray {
  static_assert(std::is_trivially_copyable_v<Record>);

 public:
  RecordArray() = default;
  explicit RecordArray(size_t count) : count_(count) {
    if (count != 0) memory_ = MemoryBlock(count * sizeof(Record), alignof(Record));
  }

  Record* data() { return reinterpret_cast<Record*>(memory_.get()); }
  const Record* data() const { return reinterpret_cast<const Record*>(memory_.get()); }
  size_t size() const { return count_; }
  bool empty() const { return count_ == 0; }
  Record& operator[](size_t i) { return data()[i]; }
  const Record& operator[](size_t i) const { return data()[i]; }
  Record* begin() { return data(); }
  Record* end() { return data() + count_; }
  const Record* begin() const { return data(); }
  const Record* end() const { return data() + count_; }

 private:
  MemoryBlock memory_;
  size_t count_ = 0;
};

}  // namespace wavecrest
