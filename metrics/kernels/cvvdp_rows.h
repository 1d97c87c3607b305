// The pointwise steps of ColorVideoVDP, one row of a band and its three opponent channels at a time.
// metrics/cvvdp/README.md has the outline.
#pragma once

#include <array>
#include <cstddef>

namespace wavecrest {

constexpr size_t kCvvdpChannels = 3;
template <class T>
using CvvdpChannels = std::array<T, kCvvdpChannels>;

// Weber contrast of the test image in units of its threshold, and what both images have of it.
struct CvvdpContrastRow {
  CvvdpChannels<const float*> fine, coarse;  // the image, and what the next level of the pyramid shows of it
  CvvdpChannels<const float*> sensitivity;   // gains included
  CvvdpChannels<const float*> reference;     // the reference's contrast in the same units
  size_t width;
  float leastBackground, greatestContrast;
  CvvdpChannels<float*> test;    // out
  CvvdpChannels<float*> mutual;  // out: min(|test|, |reference|)
};

// Visible differences. With pow(x, p) = (x + offset)^p - offset^p and T, R the contrasts of both images,
//   M_c = sum over channels k of crossMasking[k][c] pow(maskGain mutual_k, maskExponent[k])
//   d_c = pow(|T_c - R_c|, differenceExponent) / (1 + M_c)
//   D_c = greatest d_c / (greatest + d_c).
struct CvvdpDifferenceRow {
  CvvdpChannels<const float*> test, reference, mutual;  // mutual contrast, blurred
  size_t width;
  float offset, differenceExponent, maskGain, greatest;
  CvvdpChannels<float> maskExponent;
  CvvdpChannels<CvvdpChannels<float>> crossMasking;
  CvvdpChannels<float*> difference;  // out: D; null where only sums are asked for
};

}  // namespace wavecrest
