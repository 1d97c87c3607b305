#include "bench/report/embedded_images.h"

#include <fmt/format.h>

#include <array>
#include <limits>

namespace wavecrest {
namespace {

// Each entry is a JPEG quality (0: PNG) and a divisor of both sides. The list goes from the best pictures to the
// smallest files. It ends at a quarter of width and height, as smaller pictures show nothing.
constexpr std::array<ImageCoding, 9> kCodings = {{
    {0, 1},
    {92, 1},
    {85, 1},
    {75, 1},
    {85, 2},
    {75, 2},
    {80, 3},
    {80, 4},
    {60, 4},
}};

// All images that a page shows: references, images of series and error maps. Images without pixels are left out.
std::vector<const ReportImage*> imagesOf(const ConvergenceReport& report) {
  std::vector<const ReportImage*> images;
  const auto add = [&](const ReportImage& image) {
    if (!image.rgb.empty()) images.push_back(&image);
  };
  for (const ReportScene& scene : report.scenes) {
    add(scene.reference);
    for (const ReportSeries& series : scene.series) {
      add(series.finalImage);
      add(series.errorMap);
      for (const ReportImage& image : series.earlierImages) add(image);
    }
  }
  return images;
}

}  // namespace

std::string base64(std::span<const uint8_t> bytes) {
  static constexpr char kAlphabet[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    // Three bytes become four digits of six bits; what the last group lacks is shown by '='.
    const size_t count = std::min<size_t>(3, bytes.size() - i);
    uint32_t group = 0;
    for (size_t k = 0; k < 3; ++k) group = (group << 8) | (k < count ? bytes[i + k] : 0U);
    for (size_t k = 0; k < 4; ++k) text += k <= count ? kAlphabet[(group >> (18 - 6 * k)) & 63U] : '=';
  }
  return text;
}

EmbeddedImages::EmbeddedImages(const ConvergenceReport& report, size_t budget) {
  const std::vector<const ReportImage*> images = imagesOf(report);
  for (const ImageCoding& coding : kCodings) {
    // The last coding has no limit, so a page always has its images.
    const bool last = coding == kCodings.back();
    if (encodeAll(images, coding, last ? std::numeric_limits<size_t>::max() : budget)) return;
  }
}

// Encodes all images with one coding. Stops and returns false once their URIs are longer than the budget.
bool EmbeddedImages::encodeAll(const std::vector<const ReportImage*>& images, const ImageCoding& coding,
                               size_t budget) {
  // Discard the URIs of an earlier coding.
  uris_.clear();
  coding_ = coding;
  size_t used = 0;
  for (const ReportImage* image : images) {
    std::string uri = fmt::format("data:image/{};base64,", coding.jpegQuality == 0 ? "png" : "jpeg") +
                      base64(encodeImage(*image, coding));
    used += uri.size();
    if (used > budget) return false;
    uris_.emplace(image, std::move(uri));
  }
  return true;
}

const std::string& EmbeddedImages::uri(const ReportImage& image) const {
  static const std::string none;
  // An image that was not encoded has an empty URI.
  const auto found = uris_.find(&image);
  return found == uris_.end() ? none : found->second;
}

std::string EmbeddedImages::remark() const {
  if (coding_.jpegQuality == 0) return "";
  const std::string size =
      coding_.reduction == 1 ? "" : fmt::format(" at 1/{} of their width and height", coding_.reduction);
  return fmt::format("Pictures on this page are JPEG of quality {}{}; measurements were made on the rendered images.",
                     coding_.jpegQuality, size);
}

}  // namespace wavecrest
