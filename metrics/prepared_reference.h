// A reference image with everything that the metrics compute from it alone, and a test image ready to be compared.
//
// Each metric's part of the reference is made when it is first asked for, once, whichever thread asks; afterwards one
// PreparedReference serves thousands of comparisons from any number of threads.
//
// Which numbers a metric sees: rmse, relmse and mape see images as they were read (two coded images as codes in 0..1; a
// coded and a linear one both as linear light), HDR-FLIP and the PU21 metrics linear light, the others 8-bit sRGB
// codes. A pixel with a NaN or infinity in either image is excluded: the error metrics leave it out of their means, for
// the others the test image takes the reference's colour there (black where the reference itself is not finite).
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "kernels/simd/isa.h"
#include "metrics/cvvdp/cvvdp.h"
#include "metrics/flip.h"
#include "metrics/hdrvdp2/hdrvdp2.h"
#include "metrics/image/image.h"
#include "metrics/ms_ssim.h"
#include "metrics/pu21.h"
#include "metrics/ssim.h"

namespace wavecrest {

struct ComparisonSettings {
  double exposure = 0;                // stops, applied to light before it becomes 8-bit codes or PU21
  bool gammaCorrectedErrors = false;  // rmse, relmse and mape on 8-bit codes instead of the values as read
  Isa isa = bestIsa();
};

// One image in the forms in which metrics look at it.
struct ComparedImage {
  ImageFile file;
  Image8 codes;
  uint64_t nonFinitePixels = 0;  // of a test image: in either image
};

class PreparedReference {
 public:
  // Throws ImageError, naming the file, for an image without pixels or without a finite one.
  PreparedReference(std::string name, ImageFile file, const ComparisonSettings& settings = {});

  // Throws ImageError when the size differs from the reference's.
  ComparedImage prepareTest(const std::string& name, ImageFile file) const;

  const std::string& name() const { return name_; }
  const ComparedImage& image() const { return image_; }
  const ComparisonSettings& settings() const { return settings_; }

  const PreparedSsim& ssim() const;
  const PreparedHdrVdp2& hdrVdp2() const;
  const PreparedFlip& flip() const;
  const PreparedHdrFlip& hdrFlip() const;
  const PreparedMsSsim& msSsim() const;
  const PreparedPu21& pu21() const;
  const PreparedCvvdp& cvvdp() const;

  // Linear light of a test image; excluded pixels take the reference's.
  Image lightOf(const ComparedImage& test) const;

  // 8-bit codes of the reference or a test for a picture of it: NaN is black, infinite light white.
  Image8 pictureOf(const ComparedImage& image) const;

 private:
  template <class T>
  struct Lazy {
    std::once_flag once;
    std::optional<T> value;
  };
  struct Parts {
    Lazy<PreparedSsim> ssim;
    Lazy<PreparedHdrVdp2> hdrVdp2;
    Lazy<PreparedFlip> flip;
    Lazy<PreparedHdrFlip> hdrFlip;
    Lazy<PreparedMsSsim> msSsim;
    Lazy<PreparedPu21> pu21;
    Lazy<PreparedCvvdp> cvvdp;
  };
  template <class T, class Make>
  static const T& get(Lazy<T>& part, Make make);

  std::string name_;
  ComparedImage image_;
  ComparisonSettings settings_;
  std::unique_ptr<Parts> parts_;
};

// Whether all three samples of a pixel are numbers.
bool finitePixel(const Image& image, size_t pixel);

// Linear light of an image file: coded files are decoded, non-finite samples replaced by zero.
Image linearLight(const ImageFile& file);

}  // namespace wavecrest
