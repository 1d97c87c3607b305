// A part of a picture that readers look at closely.
#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace wavecrest {

/// Pixels from the top left.
struct PictureCrop {
  uint32_t x = 0, y = 0, width = 0, height = 0;

  /// Whether an image of that size has all of it.
  bool liesIn(uint32_t imageWidth, uint32_t imageHeight) const {
    return uint64_t{x} + width <= imageWidth && uint64_t{y} + height <= imageHeight;
  }
};

/// "X,Y,WIDTHxHEIGHT" of at least one pixel; nothing for any other text.
inline std::optional<PictureCrop> parseCrop(std::string_view text) {
  PictureCrop crop;
  const char* at = text.data();
  const char* const end = at + text.size();
  const auto number = [&](uint32_t& value, char after) {
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc() || (after == 0 ? next != end : next == end || *next != after)) return false;
    at = next + (after == 0 ? 0 : 1);
    return true;
  };
  const bool valid = number(crop.x, ',') && number(crop.y, ',') && number(crop.width, 'x') && number(crop.height, 0);
  return valid && crop.width > 0 && crop.height > 0 ? std::optional(crop) : std::nullopt;
}

/// A crop of one of several scenes.
struct SceneCrop {
  std::string scene;
  PictureCrop crop;
};

/// "SCENE:X,Y,WIDTHxHEIGHT"; nothing for any other text.
inline std::optional<SceneCrop> parseSceneCrop(std::string_view text) {
  const size_t colon = text.rfind(':');
  if (colon == 0 || colon == std::string_view::npos) return std::nullopt;
  const std::optional<PictureCrop> crop = parseCrop(text.substr(colon + 1));
  if (!crop) return std::nullopt;
  return SceneCrop{std::string(text.substr(0, colon)), *crop};
}

}  // namespace wavecrest
