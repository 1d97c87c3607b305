// Memory for columns, photons and hierarchies: aligned, and on large pages where it fills one.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>

namespace wavecrest {

// Bytes of a large page. What is read in no order, as photons and nodes are, misses few address translations on them.
constexpr size_t kLargePage = size_t{2} << 20;

// Not initialised. Movable only.
class MemoryBlock {
 public:
  MemoryBlock() = default;
  // A block of sizeFor(bytes, alignment) bytes on a multiple of `alignment`, a power of two; from kLargePage on it asks
  // the system for large pages. Throws std::bad_alloc.
  MemoryBlock(size_t bytes, size_t alignment) : size_(sizeFor(bytes, alignment)) {
    const bool large = bytes >= kLargePage;
    block_.reset(static_cast<std::byte*>(std::aligned_alloc(large ? kLargePage : alignment, size_)));
    if (block_ == nullptr && size_ != 0) throw std::bad_alloc();
    if (large) madvise(block_.get(), size_, MADV_HUGEPAGE);  // where it cannot, pages are small
  }

  // Whole multiples of the alignment, or whole large pages.
  static constexpr size_t sizeFor(size_t bytes, size_t alignment) {
    const size_t unit = bytes >= kLargePage ? kLargePage : alignment;
    return (bytes + unit - 1) / unit * unit;
  }

  std::byte* get() const { return block_.get(); }
  size_t size() const { return size_; }

 private:
  struct Free {
    void operator()(std::byte* p) const { std::free(p); }
  };
  std::unique_ptr<std::byte, Free> block_;
  size_t size_ = 0;
};

}  // namespace wavecrest
