#include "metrics/planes/fft.h"

#include <algorithm>
#include <bit>
#include <complex>
#include <cstring>
#include <numbers>

#include "metrics/kernels/metric_kernels.h"
#include "metrics/planes/plane.h"

namespace wavecrest {
namespace {

constexpr size_t kGreatestRadix = 13;

// Factors in the order in which they are applied: fours first, then what is left. Empty if a prime is too large.
std::vector<size_t> factorize(size_t length) {
  std::vector<size_t> factors;
  for (size_t radix : {size_t{4}, size_t{2}, size_t{3}, size_t{5}, size_t{7}, size_t{11}, kGreatestRadix}) {
    for (; length % radix == 0; length /= radix) factors.push_back(radix);
  }
  return length == 1 ? factors : std::vector<size_t>{};
}

// e^(-2 pi i numerator / denominator), with the angle reduced in whole numbers.
std::complex<double> rootOfUnity(size_t numerator, size_t denominator) {
  const double turn = static_cast<double>(numerator % denominator) / static_cast<double>(denominator);
  return std::polar(1.0, -2 * std::numbers::pi * turn);
}

void append(std::vector<float>& list, std::complex<double> z) {
  list.push_back(static_cast<float>(z.real()));
  list.push_back(static_cast<float>(z.imag()));
}

}  // namespace

FftPlan::FftPlan(size_t length, Isa isa) : isa_(isa), length_(length) {
  if (length <= 1) return;
  makeStages();
  // Without stages, the length has a prime factor that is too large.
  if (stages_.empty()) makeChirp();
}

// One stage for each factor. `remaining` is the length of its sub-transforms.
void FftPlan::makeStages() {
  size_t remaining = length_, stride = 1;
  for (size_t radix : factorize(length_)) {
    FftStage stage{radix, remaining / radix, stride, {}, {}};
    for (size_t p = 0; p < stage.m; ++p)
      for (size_t k = 1; k < radix; ++k) append(stage.twiddles, rootOfUnity(p * k, remaining));
    for (size_t j = 0; j < radix; ++j) append(stage.roots, rootOfUnity(j, radix));
    stages_.push_back(std::move(stage));
    remaining /= radix;
    stride *= radix;
  }
}

// Bluestein 1970: j k = (j^2 + k^2 - (k - j)^2) / 2 turns the transform into a convolution with the chirp
// c_k = e^(-pi i k^2 / length), done by transforms of a power of two.
void FftPlan::makeChirp() {
  inner_ = std::make_unique<FftPlan>(std::bit_ceil(2 * length_ - 1), isa_);
  const size_t n = inner_->length();
  // The conjugate chirp, even about element 0 of the cyclic convolution. One lane of the batch is enough.
  AlignedArray<float> batch(n * kFftElement), work(inner_->workFloats());
  for (size_t k = 0; k < length_; ++k) {
    // k^2 modulo 2 length keeps the angle exact; k < 2^32, so the square fits.
    const std::complex<double> c = rootOfUnity(k * k % (2 * length_), 2 * length_);
    append(chirp_, c);
    for (size_t at : {k, (n - k) % n}) {
      batch.data()[at * kFftElement] = static_cast<float>(c.real());
      batch.data()[at * kFftElement + kFftBatch] = static_cast<float>(-c.imag());
    }
  }
  // The spectrum includes the scale of the inverse inner transform.
  inner_->transform(batch.data(), work.data(), FftDirection::forward);
  for (size_t k = 0; k < n; ++k) {
    const float* element = batch.data() + k * kFftElement;
    append(chirpSpectrum_, std::complex<double>(element[0], element[kFftBatch]) / static_cast<double>(n));
  }
}

size_t FftPlan::workFloats() const {
  if (!inner_) return length_ * kFftElement;
  return inner_->length() * kFftElement + inner_->workFloats();
}

float* FftPlan::runStages(float* data, float* other, FftDirection direction) const {
  const auto kernel = metricKernels(isa_).fftStage;
  for (const FftStage& stage : stages_) {
    kernel(stage, data, other, direction);
    std::swap(data, other);
  }
  return data;
}

void FftPlan::transform(float* data, float* work, FftDirection direction) const {
  if (!inner_) {
    // Stages alternate between the two buffers, so the result may be in either.
    const float* result = runStages(data, work, direction);
    if (result != data) std::memcpy(data, result, length_ * kFftElement * sizeof(float));
    return;
  }
  // Bluestein: multiply by the chirp, convolve with its conjugate, multiply by the chirp. For the inverse, every step
  // exchanges real and imaginary parts.
  const MetricKernels& kernels = metricKernels(isa_);
  const size_t n = inner_->length();
  float* padded = work;
  float* innerWork = work + n * kFftElement;
  kernels.multiplyElements(data, chirp_.data(), padded, length_, direction);
  std::fill(padded + length_ * kFftElement, padded + n * kFftElement, 0.0f);
  inner_->transform(padded, innerWork, direction);
  kernels.multiplyElements(padded, chirpSpectrum_.data(), padded, n, direction);
  inner_->transform(padded, innerWork,
                    direction == FftDirection::forward ? FftDirection::inverse : FftDirection::forward);
  kernels.multiplyElements(padded, chirp_.data(), data, length_, direction);
}

}  // namespace wavecrest
