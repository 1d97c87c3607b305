#include "engine/load/bitmap_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/load/bmp.h"
#include "engine/load/input_file.h"
#include "engine/load/jpeg.h"
#include "engine/load/tga.h"
#include "engine/load/values.h"
#include "metrics/image/image_io.h"
#include "metrics/image/srgb.h"

namespace wavecrest {

namespace {

// The usual extension of files that start with these bytes.
struct Signature {
  std::string_view bytes, extension;
};
constexpr std::array<Signature, 7> kSignatures = {{{"\x89PNG", ".png"},
                                                   {"\xff\xd8", ".jpg"},
                                                   {"\x76\x2f\x31\x01", ".exr"},
                                                   {"#?", ".hdr"},
                                                   {"BM", ".bmp"},
                                                   {"PF", ".pfm"},
                                                   {"Pf", ".pfm"}}};

// The extension that says what the file is. As in Mitsuba its first bytes decide, and where they say nothing, as those
// of TGA, its name.
std::string formatOf(const std::filesystem::path& path, std::string_view bytes) {
  for (const Signature& signature : kSignatures) {
    if (bytes.starts_with(signature.bytes)) return std::string(signature.extension);
  }
  return toLower(path.extension().string());
}

ImageFile readImageFile(const std::filesystem::path& path, const SourceLocation& where) {
  const std::vector<char> bytes = readInputFile(path, where);
  const std::string name = path.string(), format = formatOf(path, {bytes.data(), bytes.size()});
  try {
    if (format == ".bmp") return decodeBmp(name, bytes);
    if (format == ".tga") return decodeTga(name, bytes);
    if (format == ".jpg" || format == ".jpeg") return decodeJpeg(name, bytes);
    const bool known =
        std::ranges::any_of(kSignatures, [&](const Signature& signature) { return signature.extension == format; });
    if (!known) {
      throw ImageError(name, format.empty() ? "unknown image format" : "unknown image format '" + format + "'",
                       "expected EXR, PFM, HDR, PNG, JPEG, BMP or TGA");
    }
    return decodeImage(name, format, {reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()});
  } catch (const ImageError& error) {
    throw LoadError(where, error.what());
  }
}

// Texels that are not finite become black, with a note that counts them.
void clearNonFinite(LoadContext& context, Bitmap& bitmap, const std::filesystem::path& path,
                    const SourceLocation& where) {
  size_t count = 0;
  for (float& value : bitmap.pixels) {
    if (std::isfinite(value)) continue;
    value = 0;
    ++count;
  }
  if (count == 0) return;
  const std::string name = inQuotes(path.filename().string());
  context.note(where, "values in " + name + " that are not finite: " + std::to_string(count), "0 is used");
}

}  // namespace

BitmapFile readBitmap(LoadContext& context, const std::filesystem::path& path, bool raw, const SourceLocation& where) {
  const std::string key = (raw ? "raw:" : "linear:") + path.string();
  if (const auto known = context.bitmaps.find(key); known != context.bitmaps.end()) return known->second;
  ImageFile file = readImageFile(path, where);
  if (file.exposure != ImageFile{}.exposure || !file.primaries.empty()) {
    context.note(where, "EXPOSURE, COLORCORR or PRIMARIES of a Radiance picture",
                 "left out, as in Mitsuba: pixels are taken as stored");
  }
  if (file.otherGamma && !raw) context.note(where, "gAMA of a PNG", "left out: the sRGB curve is used");
  auto bitmap = std::make_shared<Bitmap>();
  bitmap->width = file.image.width;
  bitmap->height = file.image.height;
  bitmap->channels = file.image.channels;
  bitmap->pixels = std::move(file.image.pixels);
  clearNonFinite(context, *bitmap, path, where);
  const bool encoded = file.encoding != Encoding::linear;
  if (encoded && !raw) {
    for (float& value : bitmap->pixels) value = static_cast<float>(srgbDecode(value));
  }
  return context.bitmaps.emplace(key, BitmapFile{.bitmap = std::move(bitmap), .encoded = encoded}).first->second;
}

}  // namespace wavecrest
