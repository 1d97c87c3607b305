// Hashes of images and the file that they are kept in.
#include "bench/score/expected.h"

#include <gtest/gtest.h>

#include <cmath>

#include <nlohmann/json.hpp>

namespace wavecrest {
namespace {

const ScoreEntry kEntry{.scene = "cornell-diffuse", .method = Method::bpt, .width = 8, .height = 8, .iterations = 8};

TEST(ImageHash, changesWithTheLastBitOfAnySample) {
  std::vector<float> image(300, 0.25f);
  const uint64_t hash = hashImage(image);
  for (const size_t i : {size_t{0}, size_t{137}, image.size() - 1}) {
    std::vector<float> other = image;
    other[i] = std::nextafter(other[i], 1.0f);
    EXPECT_NE(hashImage(other), hash) << i;
  }
  std::vector<float> swapped = image;
  swapped[0] = 1;
  swapped[1] = 2;
  std::vector<float> ordered = image;
  ordered[0] = 2;
  ordered[1] = 1;
  EXPECT_NE(hashImage(swapped), hashImage(ordered));
}

TEST(ImageHashes, areThoseThatWereWritten) {
  ImageHashes hashes;
  hashes.set(ScoreSize::small, "avx2", kEntry, 0x0123456789abcdefu);
  hashes.set(ScoreSize::large, "avx512", kEntry, 7);
  hashes.setBuild(ScoreSize::small, "avx2", "0.1.0, GCC 12");
  const ImageHashes read = ImageHashes::parse(nlohmann::json::parse(hashes.toJson().dump()));
  EXPECT_EQ(read.find(ScoreSize::small, "avx2", kEntry), 0x0123456789abcdefu);
  EXPECT_EQ(read.find(ScoreSize::large, "avx512", kEntry), 7u);
  EXPECT_EQ(read.find(ScoreSize::small, "avx512", kEntry), std::nullopt);
  ScoreEntry other = kEntry;
  other.method = Method::pt;
  EXPECT_EQ(read.find(ScoreSize::small, "avx2", other), std::nullopt);
  EXPECT_EQ(read.buildOf(ScoreSize::small, "avx2"), "0.1.0, GCC 12");
  EXPECT_EQ(read.buildOf(ScoreSize::large, "avx512"), "");
}

TEST(ImageHashes, ofOtherFilesAreRefused) {
  using nlohmann::json;
  EXPECT_THROW(ImageHashes::parse(json::array()), ScoreFileError);
  EXPECT_THROW(ImageHashes::parse({{"score_version", kScoreVersion}}), ScoreFileError);
  EXPECT_THROW(ImageHashes::parse({{"score_version", kScoreVersion + 1}, {"images", json::object()}}), ScoreFileError);
  const auto withHash = [](const json& hash) {
    return json{{"score_version", kScoreVersion}, {"images", {{"small", {{"avx2", {{"box", {{"pt", hash}}}}}}}}}};
  };
  EXPECT_NO_THROW(ImageHashes::parse(withHash("00000000000000ff")));
  for (const json& hash : {json("ff"), json("00000000000000fg"), json(255), json()}) {
    EXPECT_THROW(ImageHashes::parse(withHash(hash)), ScoreFileError) << hash;
  }
}

TEST(ReferenceMachine, hasARateForEveryEntryOfEverySize) {
  for (const ScoreSize size : {ScoreSize::small, ScoreSize::medium, ScoreSize::large}) {
    for (const ScoreEntry& entry : workloadOf(size)) EXPECT_GT(referenceMachine().rateOf(entry), 1e4) << entry.scene;
  }
  EXPECT_FALSE(referenceMachine().name.empty());
}

}  // namespace
}  // namespace wavecrest
