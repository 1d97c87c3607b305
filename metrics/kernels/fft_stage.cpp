// fftStage: one radix step on a batch of 16 transforms. in, out: whole batches, distinct. metrics/kernels/fft_stage.h.
// multiplyElements: each element of a batch times its own complex number.
// multiplyGain: a batch of the given length times a real gain per lane and frequency, even in the frequency.
#include "metrics/kernels/fft_stage.h"

#include "kernels/simd/lanes.h"

WAVECREST_SIMD_BEGIN

namespace {

struct Complex {
  Float re, im;
};

WAVECREST_INLINE Complex operator+(Complex a, Complex b) { return {a.re + b.re, a.im + b.im}; }
WAVECREST_INLINE Complex operator-(Complex a, Complex b) { return {a.re - b.re, a.im - b.im}; }
WAVECREST_INLINE Complex timesMinusI(Complex a) { return {a.im, -a.re}; }
WAVECREST_INLINE Complex operator*(Float s, Complex a) { return {s * a.re, s * a.im}; }
WAVECREST_INLINE Complex operator*(Complex a, Complex b) {
  return {mulSub(a.re, b.re, a.im * b.im), mulAdd(a.re, b.im, a.im * b.re)};
}

// Where real and imaginary parts of an element lie: exchanged for the inverse transform.
struct Parts {
  size_t re, im;
};

WAVECREST_INLINE Complex loadElement(const float* p, Parts parts) { return {load(p + parts.re), load(p + parts.im)}; }
WAVECREST_INLINE void storeElement(Complex a, float* p, Parts parts) {
  store(a.re, p + parts.re);
  store(a.im, p + parts.im);
}

// The transform of kRadix elements in place: a_k becomes the sum over j of a_j e^(-2 pi i j k / kRadix).
template <size_t kRadix>
struct Dft;
template <>
struct Dft<2> {
  static WAVECREST_INLINE void apply(Complex (&a)[2]) {
    const Complex sum = a[0] + a[1];
    a[1] = a[0] - a[1];
    a[0] = sum;
  }
};
template <>
struct Dft<3> {
  static WAVECREST_INLINE void apply(Complex (&a)[3]) {
    // The cosine and the sine of 120 degrees are -1/2 and 0.866.
    const Complex sum = a[1] + a[2], turned = Float(0.866025404f) * timesMinusI(a[1] - a[2]);
    const Complex middle = a[0] - Float(0.5f) * sum;
    a[0] = a[0] + sum;
    a[1] = middle + turned;
    a[2] = middle - turned;
  }
};
template <>
struct Dft<4> {
  static WAVECREST_INLINE void apply(Complex (&a)[4]) {
    const Complex even = a[0] + a[2], evenDifference = a[0] - a[2];
    const Complex odd = a[1] + a[3], oddTurned = timesMinusI(a[1] - a[3]);
    a[0] = even + odd;
    a[1] = evenDifference + oddTurned;
    a[2] = even - odd;
    a[3] = evenDifference - oddTurned;
  }
};
template <>
struct Dft<5> {
  static WAVECREST_INLINE void apply(Complex (&a)[5]) {
    // Cosines and sines of 72 and 144 degrees.
    const Float c1(0.309016994f), c2(-0.809016994f), s1(0.951056516f), s2(0.587785252f);
    const Complex sum1 = a[1] + a[4], sum2 = a[2] + a[3];
    const Complex turned1 = timesMinusI(a[1] - a[4]), turned2 = timesMinusI(a[2] - a[3]);
    const Complex middle1 = a[0] + c1 * sum1 + c2 * sum2, middle2 = a[0] + c2 * sum1 + c1 * sum2;
    const Complex side1 = s1 * turned1 + s2 * turned2, side2 = s2 * turned1 - s1 * turned2;
    a[0] = a[0] + sum1 + sum2;
    a[1] = middle1 + side1;
    a[2] = middle2 + side2;
    a[3] = middle2 - side2;
    a[4] = middle1 - side1;
  }
};

// One stage of a radix that has a transform of its own. fft_stage.h explains p, q, j, k, m and stride.
template <size_t kRadix>
void radixStage(const FftStage& stage, const float* in, float* out, Parts parts) {
  const size_t inStep = stage.stride * stage.m * kFftElement, outStep = stage.stride * kFftElement;
  for (size_t p = 0; p < stage.m; ++p) {
    // The twiddles w^(p k) are the same for all q and all lanes.
    Complex twiddle[kRadix];
    for (size_t k = 1; k < kRadix; ++k) {
      const float* w = stage.twiddles.data() + 2 * (p * (kRadix - 1) + k - 1);
      twiddle[k] = {Float(w[0]), Float(w[1])};
    }
    const float* source = in + stage.stride * p * kFftElement;
    float* target = out + stage.stride * kRadix * p * kFftElement;
    for (size_t q = 0; q < stage.stride; ++q, source += kFftElement, target += kFftElement) {
      for (size_t lane = 0; lane < kFftBatch; lane += kLanes) {
        // Elements p + m j are transformed over j, multiplied by their twiddles and stored as elements radix p + k.
        Complex a[kRadix];
        for (size_t j = 0; j < kRadix; ++j) a[j] = loadElement(source + j * inStep + lane, parts);
        Dft<kRadix>::apply(a);
        storeElement(a[0], target + lane, parts);
        for (size_t k = 1; k < kRadix; ++k) storeElement(a[k] * twiddle[k], target + k * outStep + lane, parts);
      }
    }
  }
}

// Any radix, by the definition: for the occasional factor of 7, 11, 13 and so on.
void anyRadixStage(const FftStage& stage, const float* in, float* out, Parts parts) {
  const size_t radix = stage.radix;
  const size_t inStep = stage.stride * stage.m * kFftElement, outStep = stage.stride * kFftElement;
  for (size_t p = 0; p < stage.m; ++p) {
    for (size_t q = 0; q < stage.stride; ++q) {
      const float* source = in + (q + stage.stride * p) * kFftElement;
      float* target = out + (q + stage.stride * radix * p) * kFftElement;
      for (size_t lane = 0; lane < kFftBatch; lane += kLanes) {
        for (size_t k = 0; k < radix; ++k) {
          // The sum over j of the elements times e^(-2 pi i j k / radix), then the twiddle.
          Complex sum = loadElement(source + lane, parts);
          for (size_t j = 1; j < radix; ++j) {
            const float* root = stage.roots.data() + 2 * (j * k % radix);
            sum = sum + Complex{Float(root[0]), Float(root[1])} * loadElement(source + j * inStep + lane, parts);
          }
          if (k > 0) {
            const float* w = stage.twiddles.data() + 2 * (p * (radix - 1) + k - 1);
            sum = sum * Complex{Float(w[0]), Float(w[1])};
          }
          storeElement(sum, target + k * outStep + lane, parts);
        }
      }
    }
  }
}

// The inverse transform is the forward one with real and imaginary parts exchanged before and after.
Parts partsOf(FftDirection direction) {
  return direction == FftDirection::forward ? Parts{0, kFftBatch} : Parts{kFftBatch, 0};
}

}  // namespace

void fftStage(const FftStage& stage, const float* in, float* out, FftDirection direction) {
  const Parts parts = partsOf(direction);
  switch (stage.radix) {
    case 2:
      return radixStage<2>(stage, in, out, parts);
    case 3:
      return radixStage<3>(stage, in, out, parts);
    case 4:
      return radixStage<4>(stage, in, out, parts);
    case 5:
      return radixStage<5>(stage, in, out, parts);
    default:
      return anyRadixStage(stage, in, out, parts);
  }
}

void multiplyElements(const float* in, const float* factors, float* out, size_t count, FftDirection direction) {
  const Parts parts = partsOf(direction);
  for (size_t k = 0; k < count; ++k) {
    const Complex factor{Float(factors[2 * k]), Float(factors[2 * k + 1])};
    for (size_t lane = 0; lane < kFftBatch; lane += kLanes) {
      storeElement(loadElement(in + k * kFftElement + lane, parts) * factor, out + k * kFftElement + lane, parts);
    }
  }
}

void multiplyGain(float* batch, const float* gain, size_t length) {
  for (size_t k = 0; k < length; ++k) {
    // Elements above length / 2 are negative frequencies, where the gain is that of the positive ones.
    const float* row = gain + (k <= length / 2 ? k : length - k) * kFftBatch;
    float* element = batch + k * kFftElement;
    for (size_t lane = 0; lane < kFftBatch; lane += kLanes) {
      const Float g = load(row + lane);
      store(load(element + lane) * g, element + lane);
      store(load(element + kFftBatch + lane) * g, element + kFftBatch + lane);
    }
  }
}

WAVECREST_SIMD_END
