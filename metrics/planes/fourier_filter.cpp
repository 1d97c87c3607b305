#include "metrics/planes/fourier_filter.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "metrics/kernels/metric_kernels.h"

namespace wavecrest {
namespace {

constexpr size_t kLanes = kFftBatch;
constexpr size_t kRowsPerBatch =
    2 * kFftBatch;  // lane j carries row 2j as its real part and row 2j + 1 as its imaginary

// Spectra hold, for each group of 16 columns and each row, the 16 real and then the 16 imaginary parts: just the
// element of a batch of column transforms. A real row of 2w samples has w + 1 columns that matter.
size_t groupsOf(size_t width) { return (width + 1 + kLanes - 1) / kLanes; }

// A 16x16 block; loads and stores through it turn rows into lanes and back.
struct Tile {
  alignas(64) float cell[kLanes][kLanes];

  void setColumn(size_t column, const float* values) {
    for (size_t i = 0; i < kLanes; ++i) cell[i][column] = values[i];
  }
  void copyColumn(size_t column, float* values) const {
    for (size_t i = 0; i < kLanes; ++i) values[i] = cell[i][column];
  }
};

// Work space that stays with the thread.
float* threadBuffer(size_t slot, size_t floats) {
  thread_local AlignedArray<float> buffers[2];
  if (buffers[slot].size() < floats) buffers[slot] = AlignedArray<float>(floats);
  return buffers[slot].data();
}

}  // namespace

FourierFilter::FourierFilter(size_t width, size_t height, Isa isa)
    : isa_(isa), width_(width), height_(height), rows_(2 * width, isa), columns_(2 * height, isa) {}

FourierGain FourierFilter::sampleGain(double samplesPerDegree, const std::function<double(double)>& gain) const {
  // Layout: [group][row frequency 0..h][16 column frequencies]; the scale of both inverse transforms is included.
  FourierGain result{AlignedArray<float>(groupsOf(width_) * (height_ + 1) * kLanes), gain(0)};
  const auto w2 = static_cast<double>(2 * width_), h2 = static_cast<double>(2 * height_);
  tbb::parallel_for(size_t{0}, groupsOf(width_), [&](size_t group) {
    for (size_t ky = 0; ky <= height_; ++ky) {
      for (size_t lane = 0; lane < kLanes; ++lane) {
        const size_t kx = group * kLanes + lane;
        // Columns beyond w fill up the last group. Their gain stays zero.
        if (kx > width_) continue;
        const double fx = static_cast<double>(kx) * samplesPerDegree / w2;
        const double fy = static_cast<double>(ky) * samplesPerDegree / h2;
        const double value = gain(std::sqrt(fx * fx + fy * fy)) / (w2 * h2);
        result.samples.data()[(group * (height_ + 1) + ky) * kLanes + lane] = static_cast<float>(value);
      }
    }
  });
  return result;
}

FourierFilter::Spectra FourierFilter::makeSpectra(size_t jobs) const {
  Spectra spectra(jobs);
  for (auto& spectrum : spectra) spectrum = AlignedArray<float>(groupsOf(width_) * height_ * kFftElement);
  return spectra;
}

// 32 rows of a plane: into lanes, transformed in pairs, pairs separated, stored as columns.
void FourierFilter::transformRows(const FourierFilterJob& job, size_t batch, float* spectrum) const {
  const size_t length = 2 * width_, firstRow = batch * kRowsPerBatch;
  const size_t rowCount = std::min(kRowsPerBatch, height_ - firstRow);
  float* data = threadBuffer(0, length * kFftElement);
  float* work = threadBuffer(1, rows_.workFloats());
  std::fill(data, data + length * kFftElement, 0.0f);
  // Rows into lanes, less the constant. The rest of each row of the torus is zero.
  const auto pad = static_cast<float>(job.pad);
  for (size_t x0 = 0; x0 < width_; x0 += kLanes) {
    const size_t xEnd = std::min(x0 + kLanes, width_);
    for (size_t i = 0; i < rowCount; ++i) {
      const float* row = job.in->row(firstRow + i);
      const size_t lane = i % 2 * kFftBatch + i / 2;
      for (size_t x = x0; x < xEnd; ++x) data[x * kFftElement + lane] = row[x] - pad;
    }
  }
  rows_.transform(data, work, FftDirection::forward);

  // Z = A + iB for real rows a, b: A_k = (Z_k + conj Z_-k) / 2, B_k = (Z_k - conj Z_-k) / 2i.
  Tile evenRe, evenIm, oddRe, oddIm;
  for (size_t group = 0; group < groupsOf(width_); ++group) {
    for (size_t i = 0; i < kLanes; ++i) {
      const size_t k = std::min(group * kLanes + i, width_);  // columns beyond w + 1 are fillers
      const float* z = data + k * kFftElement;
      const float* mirrored = data + (length - k) % length * kFftElement;  // NOLINT(*UndefinedBinaryOperatorResult)
      float ar[kLanes], ai[kLanes], br[kLanes], bi[kLanes];
      for (size_t lane = 0; lane < kLanes; ++lane) {
        const float re = z[lane], im = z[kLanes + lane], mre = mirrored[lane], mim = mirrored[kLanes + lane];
        ar[lane] = 0.5f * (re + mre);
        ai[lane] = 0.5f * (im - mim);
        br[lane] = 0.5f * (im + mim);
        bi[lane] = 0.5f * (mre - re);
      }
      evenRe.setColumn(i, ar);
      evenIm.setColumn(i, ai);
      oddRe.setColumn(i, br);
      oddIm.setColumn(i, bi);
    }
    for (size_t row = 0; row < rowCount; ++row) {
      float* out = spectrum + (group * height_ + firstRow + row) * kFftElement;
      std::memcpy(out, (row % 2 ? oddRe : evenRe).cell[row / 2], sizeof evenRe.cell[0]);
      std::memcpy(out + kLanes, (row % 2 ? oddIm : evenIm).cell[row / 2], sizeof evenIm.cell[0]);
    }
  }
}

// 16 columns of a spectrum: forward, times the gain, and back, in place.
void FourierFilter::filterColumns(const FourierGain& gain, size_t group, float* spectrum) const {
  const size_t length = 2 * height_, used = height_ * kFftElement;
  float* data = threadBuffer(0, length * kFftElement);
  float* work = threadBuffer(1, columns_.workFloats());
  // The lower half of the torus is zero on the way in, and is not needed on the way out.
  float* columns = spectrum + group * used;
  std::memcpy(data, columns, used * sizeof(float));
  std::fill(data + used, data + length * kFftElement, 0.0f);
  columns_.transform(data, work, FftDirection::forward);
  metricKernels(isa_).multiplyGain(data, gain.samples.data() + group * (height_ + 1) * kLanes, length);
  columns_.transform(data, work, FftDirection::inverse);
  std::memcpy(columns, data, used * sizeof(float));
}

// The inverse of transformRows; constant is what the padding contributes everywhere.
void FourierFilter::restoreRows(const FourierFilterJob& job, double constant, size_t batch,
                                const float* spectrum) const {
  const size_t length = 2 * width_, firstRow = batch * kRowsPerBatch;
  const size_t rowCount = std::min(kRowsPerBatch, height_ - firstRow);
  float* data = threadBuffer(0, length * kFftElement);
  float* work = threadBuffer(1, rows_.workFloats());
  Tile evenRe{}, evenIm{}, oddRe{}, oddIm{};
  for (size_t group = 0; group < groupsOf(width_); ++group) {
    for (size_t row = 0; row < rowCount; ++row) {
      const float* in = spectrum + (group * height_ + firstRow + row) * kFftElement;
      std::memcpy((row % 2 ? oddRe : evenRe).cell[row / 2], in, sizeof evenRe.cell[0]);
      std::memcpy((row % 2 ? oddIm : evenIm).cell[row / 2], in + kLanes, sizeof evenIm.cell[0]);
    }
    // Z_k = A_k + i B_k and Z_-k = conj A_k + i conj B_k.
    for (size_t i = 0; i < kLanes && group * kLanes + i <= width_; ++i) {
      const size_t k = group * kLanes + i;
      float ar[kLanes], ai[kLanes], br[kLanes], bi[kLanes];
      evenRe.copyColumn(i, ar);
      evenIm.copyColumn(i, ai);
      oddRe.copyColumn(i, br);
      oddIm.copyColumn(i, bi);
      float* mirrored = data + (length - k) % length * kFftElement;
      float* z = data + k * kFftElement;
      for (size_t lane = 0; lane < kLanes; ++lane) {
        mirrored[lane] = ar[lane] + bi[lane];
        mirrored[kLanes + lane] = br[lane] - ai[lane];
      }
      for (size_t lane = 0; lane < kLanes; ++lane) {
        z[lane] = ar[lane] - bi[lane];
        z[kLanes + lane] = ai[lane] + br[lane];
      }
    }
  }
  rows_.transform(data, work, FftDirection::inverse);
  // The left half of each row goes back to the plane, with the constant added.
  const auto offset = static_cast<float>(constant);
  for (size_t x0 = 0; x0 < width_; x0 += kLanes) {
    const size_t xEnd = std::min(x0 + kLanes, width_);
    for (size_t i = 0; i < rowCount; ++i) {
      float* row = job.out->row(firstRow + i);
      const size_t lane = i % 2 * kFftBatch + i / 2;
      for (size_t x = x0; x < xEnd; ++x) row[x] = data[x * kFftElement + lane] + offset;
    }
  }
}

void FourierFilter::apply(const FourierGain& gain, std::span<const FourierFilterJob> jobs, Spectra& spectra) const {
  // Rows forward; columns forward, gain and back; rows back. Tasks are independent within each of the three.
  const size_t batches = (height_ + kRowsPerBatch - 1) / kRowsPerBatch, groups = groupsOf(width_);
  tbb::parallel_for(size_t{0}, jobs.size() * batches, [&](size_t task) {
    transformRows(jobs[task / batches], task % batches, spectra[task / batches].data());
  });
  tbb::parallel_for(size_t{0}, jobs.size() * groups,
                    [&](size_t task) { filterColumns(gain, task % groups, spectra[task / groups].data()); });
  tbb::parallel_for(size_t{0}, jobs.size() * batches, [&](size_t task) {
    const FourierFilterJob& job = jobs[task / batches];
    restoreRows(job, job.pad * gain.atZero, task % batches, spectra[task / batches].data());
  });
}

}  // namespace wavecrest
