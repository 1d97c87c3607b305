#include "bench/score/expected_pictures.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <nlohmann/json.hpp>

#include "bench/report/embedded_images.h"
#include "bench/score/expected.h"
#include "bench/score/nested_keys.h"
#include "bench/score/score_files.h"
#include "engine/film/pixel_blocks.h"

namespace wavecrest {
namespace {

constexpr size_t kCodes = size_t{3} * kPictureWidth * kPictureHeight;
constexpr size_t kBlocks = size_t{kPictureWidth / PixelBlocks::kSide} * (kPictureHeight / PixelBlocks::kSide);
static_assert(std::endian::native == std::endian::little);  // block means are stored as their bytes

std::string keyOf(ScoreSize size, const ScoreEntry& entry) {
  return fmt::format("{}/{}/{}", kScoreSizeNames[static_cast<size_t>(size)], entry.scene, toString(entry.method));
}

// The value of a base64 digit, 0 to 63; 64 for any other character.
uint32_t digitOf(char c) {
  if (c >= 'A' && c <= 'Z') return static_cast<uint32_t>(c - 'A');
  if (c >= 'a' && c <= 'z') return static_cast<uint32_t>(c - 'a') + 26;
  if (c >= '0' && c <= '9') return static_cast<uint32_t>(c - '0') + 52;
  return c == '+' ? 62 : c == '/' ? 63 : 64;
}

// Decodes base64 without padding to `size` bytes, a multiple of three. Throws ScoreFileError if the text has another
// length or other characters.
std::vector<uint8_t> bytesOfBase64(std::string_view text, size_t size) {
  if (text.size() != size / 3 * 4) {
    throw ScoreFileError(fmt::format("has a picture of {} characters; expected {}", text.size(), size / 3 * 4));
  }
  std::vector<uint8_t> bytes;
  bytes.reserve(size);
  for (size_t i = 0; i < text.size(); i += 4) {
    uint32_t group = 0;
    for (size_t k = 0; k < 4; ++k) {
      const uint32_t digit = digitOf(text[i + k]);
      if (digit == 64) throw ScoreFileError("has a picture that is not in base64");
      group = (group << 6) | digit;
    }
    for (const int shift : {16, 8, 0}) bytes.push_back(static_cast<uint8_t>(group >> shift));
  }
  return bytes;
}

ScorePicture parsePicture(const nlohmann::json& json) {
  ScorePicture picture;
  picture.codes = {.width = kPictureWidth,
                   .height = kPictureHeight,
                   .pixels = bytesOfBase64(json.at("codes").get<std::string>(), kCodes)};
  const std::vector<uint8_t> means = bytesOfBase64(json.at("block_means").get<std::string>(), sizeof(float) * kBlocks);
  picture.blockMeans.resize(kBlocks);
  std::memcpy(picture.blockMeans.data(), means.data(), means.size());
  return picture;
}

nlohmann::ordered_json pictureJson(const ScorePicture& picture) {
  std::vector<uint8_t> means(sizeof(float) * picture.blockMeans.size());
  std::memcpy(means.data(), picture.blockMeans.data(), means.size());
  return {{"codes", base64(picture.codes.pixels)}, {"block_means", base64(means)}};
}

}  // namespace

ExpectedPictures ExpectedPictures::parse(const nlohmann::json& file) {
  if (!file.is_object() || file.value("score_version", 0) != kScoreVersion || !file.contains("pictures")) {
    throw ScoreFileError(fmt::format("has no pictures of score version {}", kScoreVersion));
  }
  ExpectedPictures all;
  try {
    forEachNested(file.at("pictures"), 3, [&](const std::string& key, const nlohmann::json& picture) {
      all.pictures_[key] = parsePicture(picture);
    });
  } catch (const nlohmann::json::exception&) {
    throw ScoreFileError("is not made of sizes, scenes, methods and pictures");
  }
  return all;
}

ExpectedPictures ExpectedPictures::committed() { return parse(nlohmann::json::parse(kImagePicturesJson)); }

nlohmann::ordered_json ExpectedPictures::toJson() const {
  nlohmann::ordered_json pictures = nlohmann::ordered_json::object();
  for (const auto& [key, picture] : pictures_) nestedPlace(pictures, key) = pictureJson(picture);
  return {{"score_version", kScoreVersion}, {"pictures", pictures}};
}

const ScorePicture* ExpectedPictures::find(ScoreSize size, const ScoreEntry& entry) const {
  const auto found = pictures_.find(keyOf(size, entry));
  return found == pictures_.end() ? nullptr : &found->second;
}

void ExpectedPictures::set(ScoreSize size, const ScoreEntry& entry, ScorePicture picture) {
  pictures_[keyOf(size, entry)] = std::move(picture);
}

}  // namespace wavecrest
