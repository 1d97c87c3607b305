// PNG through libpng. Values are the file's codes over 255 or 65535, never gamma-converted: a PNG is taken as sRGB.
// libpng reports errors by longjmp, so everything with a destructor lives outside the frames that may be left that way.
#include <png.h>

#include <csetjmp>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "metrics/image/atomic_file.h"
#include "metrics/image/codecs.h"
#include "metrics/image/image_io.h"

namespace wavecrest {
namespace {

constexpr size_t kMessageSize = 160;

// The error callback of libpng. It must not return, so it keeps the text and jumps back.
void storeError(png_structp png, png_const_charp text) {
  auto* message = static_cast<char*>(png_get_error_ptr(png));
  std::strncpy(message, text, kMessageSize - 1);
  png_longjmp(png, 1);
}
void ignoreWarning(png_structp, png_const_charp) {}

// ---- reading --------------------------------------------------------------------------------------------------------

// The state of one read from memory. message tells what libpng found wrong.
struct PngReader {
  png_structp png = nullptr;
  png_infop info = nullptr;
  const unsigned char* cursor = nullptr;
  size_t left = 0;
  char message[kMessageSize] = {};

  PngReader(const unsigned char* data, size_t size) : cursor(data), left(size) {
    png = png_create_read_struct(PNG_LIBPNG_VER_STRING, message, storeError, ignoreWarning);
    if (png) info = png_create_info_struct(png);
  }
  ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
};

// The read callback of libpng.
void takeBytes(png_structp png, png_bytep out, size_t count) {
  auto* reader = static_cast<PngReader*>(png_get_io_ptr(png));
  if (count > reader->left) png_error(png, "file ends early");
  std::memcpy(out, reader->cursor, count);
  reader->cursor += count;
  reader->left -= count;
}

// Whether the file names another gamma than sRGB's, by more than 1 %. An sRGB chunk takes precedence.
bool hasOtherGamma(const PngReader& reader) {
  constexpr png_fixed_point kSrgbGamma = 45455;  // 1 / 2.2 times 100000
  png_fixed_point gamma = 0;
  if (png_get_valid(reader.png, reader.info, PNG_INFO_sRGB) != 0) return false;
  if (png_get_gAMA_fixed(reader.png, reader.info, &gamma) == 0) return false;
  return std::abs(gamma - kSrgbGamma) > kSrgbGamma / 100;
}

// Header and the conversion to three channels of 8 or 16 bits. False: reader.message tells why.
bool startReading(PngReader& reader) {
  if (setjmp(png_jmpbuf(reader.png))) return false;
  // libpng refuses sides longer than 2^20.
  png_set_user_limits(reader.png, 1u << 20, 1u << 20);
  png_set_read_fn(reader.png, &reader, takeBytes);
  png_read_info(reader.png, reader.info);
  const int colorType = png_get_color_type(reader.png, reader.info);
  if (colorType == PNG_COLOR_TYPE_PALETTE) png_set_palette_to_rgb(reader.png);
  if (png_get_bit_depth(reader.png, reader.info) < 8) png_set_expand_gray_1_2_4_to_8(reader.png);
  if (!(colorType & PNG_COLOR_MASK_COLOR)) png_set_gray_to_rgb(reader.png);
  png_set_strip_alpha(reader.png);  // palettes may have an alpha channel as well
  png_set_interlace_handling(reader.png);
  png_read_update_info(reader.png, reader.info);
  return true;
}

// All pixels, after startReading. False: reader.message tells why.
bool readRows(PngReader& reader, png_bytepp rows) {
  if (setjmp(png_jmpbuf(reader.png))) return false;
  png_read_image(reader.png, rows);
  png_read_end(reader.png, nullptr);
  return true;
}

// ---- writing --------------------------------------------------------------------------------------------------------

// The state of one write to memory. message tells what libpng found wrong.
struct PngWriter {
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::vector<unsigned char> bytes;
  char message[kMessageSize] = {};

  PngWriter() {
    png = png_create_write_struct(PNG_LIBPNG_VER_STRING, message, storeError, ignoreWarning);
    if (png) info = png_create_info_struct(png);
  }
  ~PngWriter() { png_destroy_write_struct(&png, &info); }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;
};

// The write callback of libpng.
void appendBytes(png_structp png, png_bytep data, size_t count) {
  auto& bytes = static_cast<PngWriter*>(png_get_io_ptr(png))->bytes;
  bytes.insert(bytes.end(), data, data + count);
}

// A whole file of 8-bit RGB. False: writer.message tells why.
bool writeRows(PngWriter& writer, uint32_t width, uint32_t height, const uint8_t* pixels) {
  if (setjmp(png_jmpbuf(writer.png))) return false;
  // Without this libpng refuses sides longer than 1,000,000.
  png_set_user_limits(writer.png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
  png_set_write_fn(writer.png, &writer, appendBytes, nullptr);
  png_set_IHDR(writer.png, writer.info, width, height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(writer.png, writer.info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_write_info(writer.png, writer.info);
  for (size_t y = 0; y < height; ++y) png_write_row(writer.png, pixels + y * width * 3);
  png_write_end(writer.png, nullptr);
  return true;
}

}  // namespace

namespace codecs {

ImageFile decodePng(const std::string& path, Bytes bytes) {
  PngReader reader(bytes.data(), bytes.size());
  if (!reader.info) throw ImageError(path, "libpng cannot be started", "expected enough memory");
  // Header and plausible size.
  auto fail = [&] {
    throw ImageError(path, std::string("PNG error: ") + reader.message, "expected an intact PNG file");
  };
  if (!startReading(reader)) fail();
  const uint32_t width = png_get_image_width(reader.png, reader.info);
  const uint32_t height = png_get_image_height(reader.png, reader.info);
  const bool deep = png_get_bit_depth(reader.png, reader.info) == 16;
  // Deflate shrinks at most 1032 times; one stored bit per pixel is the least a PNG can hold before that.
  checkSize(path, width, height, uint64_t{width} * height / 8 / 1040, bytes.size());

  const size_t rowBytes = size_t{width} * 3 * (deep ? 2 : 1);
  if (png_get_rowbytes(reader.png, reader.info) != rowBytes)
    throw ImageError(path, "unusual PNG pixel layout", "expected grey, RGB or palette with or without alpha");
  // Pixels. libpng takes a list of pointers to the rows.
  std::vector<unsigned char> codes(rowBytes * height);
  std::vector<png_bytep> rows(height);
  for (size_t y = 0; y < height; ++y) rows[y] = codes.data() + y * rowBytes;
  if (!readRows(reader, rows.data())) fail();

  ImageFile file{{width, height, 3, {}}, deep ? Encoding::srgb16 : Encoding::srgb8, {}};
  file.otherGamma = hasOtherGamma(reader);
  file.image.pixels.resize(size_t{width} * height * 3);
  // Codes become values in 0..1. Those of 16 bits have their high byte first.
  for (size_t i = 0; i < file.image.pixels.size(); ++i) {
    const int code = deep ? codes[2 * i] << 8 | codes[2 * i + 1] : codes[i];
    file.image.pixels[i] = static_cast<float>(code) / (deep ? 65535.0f : 255.0f);
  }
  return file;
}

}  // namespace codecs

std::vector<unsigned char> encodePng(const std::string& path, uint32_t width, uint32_t height, const uint8_t* rgb) {
  PngWriter writer;
  if (!writer.info) throw ImageError(path, "libpng cannot be started", "expected enough memory");
  if (!writeRows(writer, width, height, rgb))
    throw ImageError(path, std::string("PNG error: ") + writer.message, "expected a writable image");
  return std::move(writer.bytes);
}

void writePng(const std::string& path, const Image8& image) {
  writeFileAtomically(path, encodePng(path, image.width, image.height, image.pixels.data()));
}

}  // namespace wavecrest
