#include "bench/report/image_coding.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <stdexcept>

#include "metrics/image/image_io.h"
#include "metrics/image/jpeg_errors.h"

namespace wavecrest {
namespace {

// Memory that libjpeg allocates by malloc. The caller frees it.
struct JpegOutput {
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
};

// Writes a JPEG file into `output`. On failure returns false with the reason in errors.message. An error of libjpeg
// jumps out of this frame by longjmp, so it holds no object with a destructor.
bool compress(JpegErrors& errors, jpeg_compress_struct& info, const ReportImage& image, int quality,
              JpegOutput& output) {
  if (setjmp(errors.returnPoint) != 0) return false;
  jpeg_create_compress(&info);
  jpeg_mem_dest(&info, &output.bytes, &output.size);
  // Describe the pixels and the coding.
  info.image_width = image.width;
  info.image_height = image.height;
  info.input_components = 3;
  info.in_color_space = JCS_RGB;
  jpeg_set_defaults(&info);
  jpeg_set_quality(&info, quality, TRUE);
  info.optimize_coding = TRUE;
  // No subsampling of colour: single coloured pixels are what a reader looks for.
  for (int component = 0; component < 3; ++component)
    info.comp_info[component].h_samp_factor = info.comp_info[component].v_samp_factor = 1;
  // Write row by row.
  jpeg_start_compress(&info, TRUE);
  while (info.next_scanline < info.image_height) {
    // libjpeg takes no const; it only reads.
    JSAMPROW row = const_cast<uint8_t*>(image.rgb.data()) + size_t{3} * image.width * info.next_scanline;
    jpeg_write_scanlines(&info, &row, 1);
  }
  jpeg_finish_compress(&info);
  return true;
}

std::vector<uint8_t> encodeJpeg(const ReportImage& image, int quality) {
  JpegErrors errors;
  jpeg_compress_struct info{};
  info.err = &errors.manager;
  JpegOutput output;
  const bool done = compress(errors, info, image, quality, output);
  jpeg_destroy_compress(&info);
  // libjpeg may leave memory behind after a failure too.
  const std::unique_ptr<unsigned char, decltype(&std::free)> owner(output.bytes, &std::free);
  if (!done) throw std::runtime_error(fmt::format("report image '{}': {}", image.label, errors.message));
  return {output.bytes, output.bytes + output.size};
}

}  // namespace

ReportImage reduced(const ReportImage& image, uint32_t factor) {
  if (factor <= 1) return image;
  ReportImage small{.label = image.label,
                    .width = (image.width + factor - 1) / factor,
                    .height = (image.height + factor - 1) / factor,
                    .rgb = {}};
  small.rgb.reserve(size_t{3} * small.width * small.height);
  for (uint32_t y = 0; y < small.height; ++y) {
    for (uint32_t x = 0; x < small.width; ++x) {
      // Blocks at the right and lower edges may have fewer pixels.
      const uint32_t right = std::min(image.width, (x + 1) * factor), bottom = std::min(image.height, (y + 1) * factor);
      const uint32_t count = (right - x * factor) * (bottom - y * factor);
      for (size_t c = 0; c < 3; ++c) {
        uint32_t sum = 0;
        for (uint32_t row = y * factor; row < bottom; ++row)
          for (uint32_t column = x * factor; column < right; ++column)
            sum += image.rgb[3 * (size_t{row} * image.width + column) + c];
        // Half of the count makes the division round to nearest.
        small.rgb.push_back(static_cast<uint8_t>((sum + count / 2) / count));
      }
    }
  }
  return small;
}

std::vector<uint8_t> encodeImage(const ReportImage& image, const ImageCoding& coding) {
  if (image.width == 0 || image.height == 0 || image.rgb.size() != size_t{3} * image.width * image.height) {
    throw std::invalid_argument(fmt::format("report image '{}': {} bytes; expected 3 x {} x {}", image.label,
                                            image.rgb.size(), image.width, image.height));
  }
  if (coding.reduction > 1) return encodeImage(reduced(image, coding.reduction), {coding.jpegQuality, 1});
  if (coding.jpegQuality != 0) return encodeJpeg(image, coding.jpegQuality);
  return encodePng(fmt::format("report image '{}'", image.label), image.width, image.height, image.rgb.data());
}

}  // namespace wavecrest
