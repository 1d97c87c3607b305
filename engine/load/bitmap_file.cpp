#include "engine/load/bitmap_file.h"

#include <algorithm>
#include <cmath>

#include "engine/load/bmp.h"
#include "engine/load/input_file.h"
#include "engine/load/jpeg.h"
#include "engine/load/tga.h"
#include "engine/load/values.h"
#include "metrics/image/image_io.h"
#include "metrics/image/srgb.h"

namespace wavecrest {

namespace {

ImageFile readImageFile(const std::filesystem::path& path, const SourceLocation& where) {
  const std::string extension = toLower(path.extension().string());
  try {
    if (extension == ".bmp") return decodeBmp(path.string(), readInputFile(path, where));
    if (extension == ".tga") return decodeTga(path.string(), readInputFile(path, where));
    if (extension == ".jpg" || extension == ".jpeg") return decodeJpeg(path.string(), readInputFile(path, where));
    // Checks with the wording of the loader that the file is there.
    if (!std::filesystem::exists(path)) readInputFile(path, where);
    return readImage(path.string());
  } catch (const ImageError& error) {
    throw LoadError(where, error.what());
  }
}

}  // namespace

std::shared_ptr<const Bitmap> readBitmap(LoadContext& context, const std::filesystem::path& path, bool raw,
                                         const SourceLocation& where) {
  const std::string key = (raw ? "raw:" : "linear:") + path.string();
  if (const auto known = context.bitmaps.find(key); known != context.bitmaps.end()) return known->second;
  ImageFile file = readImageFile(path, where);
  auto bitmap = std::make_shared<Bitmap>();
  bitmap->width = file.image.width;
  bitmap->height = file.image.height;
  bitmap->channels = file.image.channels;
  bitmap->pixels = std::move(file.image.pixels);
  for (size_t i = 0; i < bitmap->pixels.size(); ++i) {
    float& value = bitmap->pixels[i];
    if (!std::isfinite(value)) {
      const size_t pixel = i / bitmap->channels;
      throw LoadError(where, path.string() + ": pixel (" + std::to_string(pixel % bitmap->width) + ", " +
                                 std::to_string(pixel / bitmap->width) + ") is not finite; expected finite values");
    }
    if (file.encoding != Encoding::linear && !raw) value = static_cast<float>(srgbDecode(value));
  }
  context.bitmaps.emplace(key, bitmap);
  return bitmap;
}

}  // namespace wavecrest
