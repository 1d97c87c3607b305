// One channel of floats laid out for SIMD: rows start at a multiple of 16 floats, every row may be read and written up
// to the next multiple of 16 beyond its width, and has room for `border` extra samples to its left and right.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>

namespace wavecrest {

constexpr size_t kPlaneLanes = 16;  // widest vector, in floats: what rows are padded to
constexpr size_t kPlaneAlignment = kPlaneLanes * sizeof(float);

constexpr size_t roundUpToLanes(size_t n) { return (n + kPlaneLanes - 1) / kPlaneLanes * kPlaneLanes; }

// Aligned, uninitialised-on-purpose float storage: planes are scratch memory that is always written before it is read.
class AlignedFloats {
 public:
  AlignedFloats() = default;
  explicit AlignedFloats(size_t count)
      : data_(static_cast<float*>(::operator new (count * sizeof(float), std::align_val_t{kPlaneAlignment}))),
        count_(count) {}
  float* data() const { return data_.get(); }
  size_t size() const { return count_; }

 private:
  struct Free {
    void operator()(float* p) const { ::operator delete (p, std::align_val_t{kPlaneAlignment}); }
  };
  std::unique_ptr<float, Free> data_;
  size_t count_ = 0;
};

class Plane {
 public:
  Plane() = default;
  Plane(size_t width, size_t height, size_t border = 0)
      : width_(width),
        height_(height),
        border_(roundUpToLanes(border)),
        stride_(roundUpToLanes(width) + 2 * border_),
        floats_(stride_ * height) {
    for (size_t i = 0; i < floats_.size(); ++i) floats_.data()[i] = 0;
  }
  size_t width() const { return width_; }
  size_t height() const { return height_; }
  size_t pixelCount() const { return width_ * height_; }
  float* row(size_t y) { return floats_.data() + y * stride_ + border_; }
  const float* row(size_t y) const { return floats_.data() + y * stride_ + border_; }

 private:
  size_t width_ = 0, height_ = 0, border_ = 0, stride_ = 0;
  AlignedFloats floats_;
};

}  // namespace wavecrest
