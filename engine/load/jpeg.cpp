#include "engine/load/jpeg.h"

#include "metrics/image/image_io.h"
#include "metrics/image/jpeg_errors.h"

namespace wavecrest {

namespace {

// Refuses other colours than grey and RGB, and sizes beyond what the file may hold. Throws ImageError.
void checkHeader(const std::string& path, const jpeg_decompress_struct& info, size_t fileBytes) {
  if (info.num_components == 4) throw ImageError(path, "JPEG in CMYK", "expected grey or RGB");
  // A block of 8 x 8 takes at least a bit or two, so the file's length bounds the size it may announce.
  constexpr size_t kPixelsPerByte = 1024;
  const size_t width = info.image_width, height = info.image_height;
  if (width * height > kPixelsPerByte * fileBytes) {
    throw ImageError(path,
                     "damaged JPEG: announces " + std::to_string(width) + " x " + std::to_string(height) +
                         " pixels in " + std::to_string(fileBytes) + " bytes",
                     "expected an intact JPEG file");
  }
  checkDecodedSize(path, width, height, fileBytes);
}

// Plain data only: false and errors.message where libjpeg fails. Throws as checkHeader.
bool decode(const std::string& path, JpegErrors& errors, jpeg_decompress_struct& info, std::span<const char> bytes,
            Image& image, std::vector<unsigned char>& row) {
  if (setjmp(errors.returnPoint) != 0) return false;
  jpeg_create_decompress(&info);
  jpeg_mem_src(&info, reinterpret_cast<const unsigned char*>(bytes.data()), static_cast<unsigned long>(bytes.size()));
  jpeg_read_header(&info, TRUE);
  checkHeader(path, info, bytes.size());
  info.out_color_space = JCS_RGB;
  jpeg_start_decompress(&info);
  image.width = info.output_width;
  image.height = info.output_height;
  const size_t rowSize = size_t{3} * image.width;
  image.pixels.resize(rowSize * image.height);
  row.resize(rowSize);
  while (info.output_scanline < info.output_height) {
    float* out = image.pixels.data() + rowSize * info.output_scanline;
    unsigned char* rows[1] = {row.data()};
    jpeg_read_scanlines(&info, rows, 1);
    for (size_t i = 0; i < rowSize; ++i) out[i] = static_cast<float>(row[i]) / 255.0f;
  }
  jpeg_finish_decompress(&info);
  return true;
}

struct Decompressor {
  jpeg_decompress_struct info{};
  Decompressor() = default;
  ~Decompressor() { jpeg_destroy_decompress(&info); }
  Decompressor(const Decompressor&) = delete;
  Decompressor& operator=(const Decompressor&) = delete;
};

}  // namespace

ImageFile decodeJpeg(const std::string& path, std::span<const char> bytes) {
  ImageFile file;
  file.encoding = Encoding::srgb8;
  std::vector<unsigned char> row;
  JpegErrors errors;
  Decompressor decompressor;
  decompressor.info.err = &errors.manager;
  if (!decode(path, errors, decompressor.info, bytes, file.image, row)) {
    throw ImageError(path, std::string("damaged JPEG: ") + errors.message, "expected an intact JPEG file");
  }
  return file;
}

}  // namespace wavecrest
