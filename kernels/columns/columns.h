// The one way to declare a queue of records as columns (structure of arrays).
//
// A record names its columns once and ties them in all(); allocation, bytes per item, clearing and the tests follow
// from that tie. Forgetting a column in all() does not compile.
//
// Contract of every queue:
//  - size <= capacity; a stage that pushes checks room for a whole block of lanes before it writes (claim()).
//  - Tail: each column has at least kColumnPadding items past capacity, so a kernel may load and store whole blocks;
//    items at and past size are never read as results.
//  - Order is that of the items that the pushing stage read, or what it says; compaction is stable.
//  - A column that this scene and method do not need is dropped before bind() and costs no memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <tuple>

#include "kernels/columns/memory_block.h"

namespace wavecrest {

constexpr size_t kColumnAlignment = 64;  // bytes: one cache line, one AVX-512 register
constexpr size_t kColumnPadding = 16;    // items: the widest block of lanes

// Items a column of this capacity occupies: whole blocks, plus one for stores that begin at the last item.
constexpr size_t paddedItems(size_t capacity) {
  return (capacity + kColumnPadding - 1) / kColumnPadding * kColumnPadding + kColumnPadding;
}

// One aligned block of memory handed out front to back; everything a wave needs is bound from one arena.
class Arena {
 public:
  Arena() = default;  // of no bytes
  explicit Arena(size_t bytes) : block_(bytes, kColumnAlignment), size_(bytes) {}

  template <class T>
  T* take(size_t items) {
    static_assert(alignof(T) <= kColumnAlignment);
    const size_t bytes = (items * sizeof(T) + kColumnAlignment - 1) / kColumnAlignment * kColumnAlignment;
    if (bytes > size_ - used_) throw std::length_error("Arena: columns need more memory than was planned");
    T* const begin = reinterpret_cast<T*>(block_.get() + used_);
    used_ += bytes;
    return begin;
  }
  size_t used() const { return used_; }

  // The bytes of an arena from which the same things were taken in the same order.
  void copyFrom(const Arena& other) {
    if (used_ != other.used_) throw std::length_error("Arena: copy of columns of another shape");
    std::memcpy(block_.get(), other.block_.get(), used_);
  }

 private:
  MemoryBlock block_;
  size_t size_ = 0, used_ = 0;
};

// A pointer to the items of one column, or to nothing if it was dropped.
template <class T>
class Column {
 public:
  [[gnu::always_inline]] operator T*() const { return data_; }
  void drop() { needed_ = false; }
  bool needed() const { return needed_; }
  size_t bytesPerItem() const { return needed_ ? sizeof(T) : 0; }
  size_t bytes(size_t capacity) const {
    return needed_ ? (paddedItems(capacity) * sizeof(T) + kColumnAlignment - 1) / kColumnAlignment * kColumnAlignment
                   : 0;
  }
  // Fills the column with zero, so that the tail holds defined values from the start.
  void bind(Arena& arena, size_t capacity) {
    if (!needed_) return;
    data_ = arena.take<T>(paddedItems(capacity));
    for (size_t i = 0; i < paddedItems(capacity); ++i) data_[i] = T{};
  }

 private:
  T* data_ = nullptr;
  bool needed_ = true;
};

// Base of every record. Derived declares Column members only, and `auto all() { return std::tie(every, column); }`.
template <class Derived>
struct Columns {
  size_t size = 0;

  size_t capacity() const { return capacity_; }

  // Memory of a queue of this capacity, and per item, without dropped columns.
  size_t bytes(size_t capacity) const {
    return std::apply([&](auto&... column) { return (column.bytes(capacity) + ...); }, tied());
  }
  size_t bytesPerItem() const {
    return std::apply([](auto&... column) { return (column.bytesPerItem() + ...); }, tied());
  }

  // All columns.
  void drop() {
    std::apply([](auto&... column) { (column.drop(), ...); }, tied());
  }

  void bind(Arena& arena, size_t capacity) {
    std::apply([&](auto&... column) { (column.bind(arena, capacity), ...); }, tied());
    capacity_ = capacity;
    size = 0;
  }

  // Index of the first of `count` new items. A queue without room for them is a planning error, never an overrun.
  size_t claim(size_t count) {
    const size_t first = size;
    if (count > capacity_ - first) fail();
    size += count;
    return first;
  }

 private:
  auto tied() const {
    // all() has one form, for writing; measuring does not write.
    auto columns = const_cast<Derived*>(static_cast<const Derived*>(this))->all();
    using Tuple = decltype(columns);
    static_assert(sizeof(Derived) == sizeof(Columns) + std::tuple_size_v<Tuple> * sizeof(Column<float>),
                  "a column is missing in all()");
    return columns;
  }
  [[noreturn, gnu::noinline, gnu::cold]] static void fail() {
    throw std::length_error("queue overrun: a stage pushed more records than were planned");
  }

  size_t capacity_ = 0;
};

}  // namespace wavecrest
