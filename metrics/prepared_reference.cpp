#include "metrics/prepared_reference.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>

#include "metrics/image/srgb.h"

namespace wavecrest {
namespace {

std::string sizeText(const Image& image) { return std::to_string(image.width) + "x" + std::to_string(image.height); }

// 8-bit sRGB codes. Codes of an 8-bit file stay as they are unless an exposure changes them.
Image8 codesOf(const ImageFile& file, double exposure) {
  if (file.encoding == Encoding::linear) return encodeSrgb8(file.image, exposure);
  if (exposure != 0) return encodeSrgb8(linearLight(file), exposure);
  // Values of an 8-bit file are code / 255, so rounding gives the codes back. Values of a 16-bit file lose precision.
  Image8 codes{file.image.width, file.image.height, std::vector<uint8_t>(file.image.pixels.size())};
  std::transform(file.image.pixels.begin(), file.image.pixels.end(), codes.pixels.begin(),
                 [](float v) { return static_cast<uint8_t>(std::lround(255 * v)); });
  return codes;
}

void copyPixel(const Image8& from, Image8& to, size_t pixel) {
  std::copy_n(from.pixels.begin() + static_cast<std::ptrdiff_t>(3 * pixel), 3,
              to.pixels.begin() + static_cast<std::ptrdiff_t>(3 * pixel));
}

}  // namespace

bool finitePixel(const Image& image, size_t pixel) {
  const float* p = image.pixels.data() + 3 * pixel;
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

Image linearLight(const ImageFile& file) {
  Image light = file.image;
  for (float& v : light.pixels) {
    if (!std::isfinite(v)) {
      v = 0;
    } else if (file.encoding != Encoding::linear) {
      v = static_cast<float>(srgbDecode(double{v}));
    }
  }
  return light;
}

PreparedReference::PreparedReference(std::string name, ImageFile file, const ComparisonSettings& settings)
    : name_(std::move(name)), settings_(settings), parts_(std::make_unique<Parts>()) {
  // Count excluded pixels, and refuse images without any other.
  const Image& image = file.image;
  if (image.pixelCount() == 0) throw ImageError(name_, "empty image", "expected at least one pixel");
  for (size_t i = 0; i < image.pixelCount(); ++i) image_.nonFinitePixels += !finitePixel(image, i);
  if (image_.nonFinitePixels == image.pixelCount())
    throw ImageError(name_, "no pixel is finite", "expected an image with numbers");
  // Excluded pixels are black in the codes.
  image_.codes = codesOf(file, settings.exposure);
  for (size_t i = 0; i < image.pixelCount(); ++i)
    if (!finitePixel(image, i))
      std::fill_n(image_.codes.pixels.begin() + static_cast<std::ptrdiff_t>(3 * i), 3, uint8_t{0});
  image_.file = std::move(file);
}

ComparedImage PreparedReference::prepareTest(const std::string& name, ImageFile file) const {
  const Image& reference = image_.file.image;
  if (file.image.width != reference.width || file.image.height != reference.height) {
    throw ImageError(name, "image of " + sizeText(file.image) + " pixels",
                     "expected " + sizeText(reference) + " as in " + name_);
  }
  // A pixel that is not finite in either image takes the reference's codes, so that the perceptual metrics see no
  // difference there.
  ComparedImage test;
  test.codes = codesOf(file, settings_.exposure);
  for (size_t i = 0; i < reference.pixelCount(); ++i) {
    if (finitePixel(file.image, i) && finitePixel(reference, i)) continue;
    ++test.nonFinitePixels;
    copyPixel(image_.codes, test.codes, i);
  }
  if (test.nonFinitePixels == reference.pixelCount())
    throw ImageError(name, "no pixel is finite in both images", "expected images with numbers");
  test.file = std::move(file);
  return test;
}

// The part, made by the first thread that asks for it. Other threads wait until it is made. Parts are made by parallel
// loops: isolated, the thread does not run a task of the caller's loop meanwhile, which could ask for the same part and
// wait for itself.
template <class T, class Make>
const T& PreparedReference::get(Lazy<T>& part, Make make) {
  std::call_once(part.once, [&] { tbb::this_task_arena::isolate([&] { part.value.emplace(make()); }); });
  return *part.value;
}

// The parts of the metrics. HDR-FLIP and PU21 see linear light, the others 8-bit codes.
const PreparedSsim& PreparedReference::ssim() const {
  return get(parts_->ssim, [&] { return PreparedSsim(image_.codes, settings_.isa); });
}
const PreparedHdrVdp2& PreparedReference::hdrVdp2() const {
  return get(parts_->hdrVdp2, [&] { return PreparedHdrVdp2(image_.codes, settings_.isa); });
}
const PreparedFlip& PreparedReference::flip() const {
  return get(parts_->flip, [&] { return PreparedFlip(image_.codes, kFlipPixelsPerDegree, settings_.isa); });
}
// HDR-FLIP chooses its exposures itself, so the exposure of the settings does not apply. What is not finite does not
// count there, so light is passed as it is.
const PreparedHdrFlip& PreparedReference::hdrFlip() const {
  return get(parts_->hdrFlip, [&] {
    const bool linear = image_.file.encoding == Encoding::linear;
    return PreparedHdrFlip(linear ? image_.file.image : linearLight(image_.file), kFlipPixelsPerDegree, settings_.isa);
  });
}

const PreparedMsSsim& PreparedReference::msSsim() const {
  return get(parts_->msSsim, [&] { return PreparedMsSsim(image_.codes, settings_.isa); });
}
const PreparedPu21& PreparedReference::pu21() const {
  return get(parts_->pu21, [&] { return PreparedPu21(linearLight(image_.file), settings_.exposure, settings_.isa); });
}
const PreparedCvvdp& PreparedReference::cvvdp() const {
  return get(parts_->cvvdp, [&] { return PreparedCvvdp(image_.codes, settings_.isa); });
}

Image PreparedReference::lightOf(const ComparedImage& test) const {
  Image light = linearLight(test.file);
  if (test.nonFinitePixels == 0) return light;
  const Image &a = image_.file.image, &b = test.file.image;
  // A pixel that is not finite in either image takes the reference's light.
  const Image referenceLight = linearLight(image_.file);
  for (size_t pixel = 0; pixel < light.pixelCount(); ++pixel) {
    const size_t i = 3 * pixel;
    if (finitePixel(a, pixel) && finitePixel(b, pixel)) continue;
    std::copy_n(referenceLight.pixels.data() + i, 3, light.pixels.data() + i);
  }
  return light;
}

Image8 PreparedReference::pictureOf(const ComparedImage& image) const {
  return image.nonFinitePixels == 0 ? image.codes : codesOf(image.file, settings_.exposure);
}

}  // namespace wavecrest
