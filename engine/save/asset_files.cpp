#include "engine/save/asset_files.h"

#include <fmt/core.h>

#include <array>
#include <memory>
#include <optional>

#include "metrics/image/atomic_file.h"
#include "metrics/image/image_io.h"
#include "metrics/image/srgb.h"

namespace wavecrest {

namespace {

// The float that the loader makes of each 8-bit code.
std::array<float, 256> lightOfCodes(bool raw) {
  std::array<float, 256> light{};
  for (size_t code = 0; code < 256; ++code) {
    const float value = static_cast<float>(code) / 255.0f;
    light[code] = raw ? value : static_cast<float>(srgbDecode(value));
  }
  return light;
}

// The 8-bit codes of a bitmap, if there are codes for all its values. One channel becomes three.
std::optional<Image8> exactCodes(const Bitmap& bitmap, bool raw) {
  const std::array<float, 256> light = lightOfCodes(raw);
  Image8 image{bitmap.width, bitmap.height, {}};
  image.pixels.reserve(size_t{bitmap.width} * bitmap.height * 3);
  for (const float value : bitmap.pixels) {
    if (!(value >= 0) || value > 1) return std::nullopt;
    const uint8_t code = raw ? static_cast<uint8_t>(value * 255.0f + 0.5f) : srgbCode(value);
    if (light[code] != value) return std::nullopt;
    image.pixels.insert(image.pixels.end(), bitmap.channels == 1 ? 3 : 1, code);
  }
  return image;
}

// Writes the mesh when it is called.
std::function<void(const std::string&)> plyWriter(std::shared_ptr<const Mesh> mesh, PlyContent content) {
  return [mesh = std::move(mesh), content = std::move(content)](const std::string& path) {
    writeFileAtomically(path, plyBytes(*mesh, content));
  };
}

}  // namespace

// Plans a file in the folder. Returns its name relative to the XML file.
std::string AssetFiles::add(const std::string& file, std::function<void(const std::string& path)> write) {
  const std::filesystem::path path = folder_ / file;
  files_.push_back({path, [path, write = std::move(write)] { write(path.string()); }});
  return name_ + "/" + file;
}

std::string AssetFiles::addMesh(const Mesh& mesh, PlyContent content) {
  // The pointer owns nothing: the scene has the mesh.
  return add(fmt::format("mesh-{}.ply", ++meshes_), plyWriter({std::shared_ptr<void>(), &mesh}, std::move(content)));
}

std::string AssetFiles::addMesh(Mesh&& mesh, PlyContent content) {
  return add(fmt::format("mesh-{}.ply", ++meshes_),
             plyWriter(std::make_shared<const Mesh>(std::move(mesh)), std::move(content)));
}

StoredBitmap AssetFiles::store(const std::shared_ptr<const Bitmap>& bitmap, std::span<const bool> curves) {
  const std::string name = fmt::format("bitmap-{}", bitmaps_.size() + environments_.size());
  for (const bool raw : curves) {
    std::optional<Image8> codes = exactCodes(*bitmap, raw);
    if (!codes) continue;
    return {add(name + ".png", [image = std::move(*codes)](const std::string& path) { writePng(path, image); }), raw};
  }
  // Floats, where no curve gives them all.
  return {add(name + ".exr",
              [bitmap](const std::string& path) {
                writeExr(path, {bitmap->width, bitmap->height, bitmap->channels, bitmap->pixels});
              }),
          curves.front()};
}

StoredBitmap AssetFiles::addBitmap(const std::shared_ptr<const Bitmap>& bitmap, bool isData) {
  // A bitmap is stored once: by the curve that suits its first use, else by the other.
  const auto [known, first] = bitmaps_.emplace(bitmap.get(), StoredBitmap{});
  if (first) known->second = store(bitmap, std::array{isData, !isData});
  return known->second;
}

std::string AssetFiles::addEnvironment(const std::shared_ptr<const Bitmap>& bitmap) {
  const auto [known, first] = environments_.emplace(bitmap.get(), StoredBitmap{});
  if (first) known->second = store(bitmap, std::array{false});
  return known->second.filename;
}

}  // namespace wavecrest
