// PSNR and SSIM of light in the perceptually uniform encoding PU21, for high dynamic range.
//
// Mantiuk, Azimi, "PU21: A novel perceptually uniform encoding for adapting existing quality metrics for HDR", Picture
// Coding Symposium 2021; constants and conventions of gfxdisp/pu21, variant "banding_glare". The encoding maps 0.005 to
// 10000 cd/m2 to 0 to 595.4 and 100 cd/m2 to about 256, which is the peak that both metrics assume.
//
// The display: linear light 1, after the exposure, is shown at 100 cd/m2, more as more, and nothing is added (no glare,
// no black level).
//  * PSNR: 10 log10(256^2 / mean square difference) over the samples of the three encoded channels; of the encoded
//    luminance beside it. Equal images would be infinitely good; scores end at kPu21GreatestPsnr.
//  * SSIM: of the encoded luminance, L = 256, 11x11 Gaussian window of sigma 1.5; the image is continued by its edge
//    pixels, so there is a window around every pixel (as in MATLAB's ssim, which the original calls).
#pragma once

#include <vector>

#include "metrics/image/image.h"
#include "metrics/ssim_layer.h"

namespace wavecrest {

constexpr double kPu21WhiteLuminance = 100;  // cd/m2 of linear light 1, after the exposure
constexpr double kPu21GreatestPsnr = 100;    // dB
constexpr double kPu21Brightest = 10'000;    // cd/m2, where the encoding ends; brighter light counts as that

struct Pu21PsnrResult {
  double colour = 0, luminance = 0;  // dB
  std::vector<float> map;            // root mean square difference of the encoded channels; empty unless asked for
};
struct Pu21SsimResult {
  double mean = 0;
  std::vector<float> map;  // SSIM around each pixel; empty unless asked for
};

// Everything that depends on the reference alone. Immutable, so one object serves any number of threads.
class PreparedPu21 {
 public:
  // Linear light of three channels, finite. exposure is in stops.
  explicit PreparedPu21(const Image& reference, double exposure = 0, Isa isa = bestIsa());

  // The test image has the reference's size.
  Pu21PsnrResult psnr(const Image& test, bool withMap = false) const;
  Pu21SsimResult ssim(const Image& test, bool withMap = false) const;

 private:
  void encodeColours(const Image& light, size_t y, float* out) const;  // interleaved
  void encodeLuminance(const Image& light, size_t y, float* out) const;

  Isa isa_;
  float scale_;  // cd/m2 of linear light 1, with exposure
  Plane colours_, luminance_;
  PreparedSsimLayer layer_;
};

}  // namespace wavecrest
