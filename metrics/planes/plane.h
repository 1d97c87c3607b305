// One channel of numbers laid out for SIMD: rows start at a multiple of 16 samples, every row may be read and written
// up to the next multiple of 16 beyond its width, and has room for `border` extra samples to its left and right.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <new>

namespace wavecrest {

constexpr size_t kPlaneLanes = 16;  // widest vector, in floats: what rows are padded to
constexpr size_t kPlaneAlignment = kPlaneLanes * sizeof(float);

constexpr size_t roundUpToLanes(size_t n) { return (n + kPlaneLanes - 1) / kPlaneLanes * kPlaneLanes; }

// Aligned storage, zero at first. Vectors read and write the padding too, which must hold harmless numbers.
template <class T>
class AlignedArray {
 public:
  AlignedArray() = default;
  explicit AlignedArray(size_t count)
      : data_(static_cast<T*>(::operator new (count * sizeof(T), std::align_val_t{kPlaneAlignment}))), count_(count) {
    std::fill_n(data_.get(), count_, T{});
  }
  T* data() const { return data_.get(); }
  size_t size() const { return count_; }

 private:
  struct Free {
    void operator()(T* p) const { ::operator delete (p, std::align_val_t{kPlaneAlignment}); }
  };
  std::unique_ptr<T, Free> data_;
  size_t count_ = 0;
};

template <class T>
class BasicPlane {
 public:
  BasicPlane() = default;
  BasicPlane(size_t width, size_t height, size_t border = 0)
      : width_(width),
        height_(height),
        border_(roundUpToLanes(border)),
        stride_(roundUpToLanes(width) + 2 * border_),
        samples_(stride_ * height) {}
  size_t width() const { return width_; }
  size_t height() const { return height_; }
  size_t pixelCount() const { return width_ * height_; }
  T* row(size_t y) { return samples_.data() + y * stride_ + border_; }
  const T* row(size_t y) const { return samples_.data() + y * stride_ + border_; }

 private:
  size_t width_ = 0, height_ = 0, border_ = 0, stride_ = 0;
  AlignedArray<T> samples_;
};

using Plane = BasicPlane<float>;

}  // namespace wavecrest
