// Comparison by pictures: images that differ by rounding are accepted; other seeds, brightness or path lengths are not.
#include "bench/score/picture.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "bench/film_image.h"
#include "bench/score/expected.h"
#include "bench/score/expected_pictures.h"
#include "bench/score/score.h"
#include "tests/bench/small_box.h"
#include "tests/effort.h"

namespace wavecrest {
namespace {

// An entry of the small workload.
ScoreEntry entryOf(const std::string& scene, Method method) {
  for (const ScoreEntry& entry : workloadOf(ScoreSize::small)) {
    if (entry.scene == scene && entry.method == method) return entry;
  }
  throw std::runtime_error("no such entry");
}

Scene sceneOf(const ScoreEntry& entry) {
  return loadScene(findScene(entry.scene), {.filmSize = std::array{entry.width, entry.height}});
}

// The image of an entry's first slice, with settings changed.
template <class Change>
Image changedImage(const Scene& scene, const ScoreEntry& entry, Change&& change) {
  RenderSettings settings = scoreSettings(scene, entry, bestIsa(), 2);
  change(settings);
  const auto session = Session::create(scene, settings);
  session->renderUntil(entry.iterations / kScoreSlices, std::nullopt);
  return filmImage(*session);
}

Image scaled(Image image, float factor) {
  for (float& sample : image.pixels) sample *= factor;
  return image;
}

// Without hashes: the committed picture decides.
ImageVerdict judge(const Image& image, const ScoreEntry& entry) {
  static const ExpectedImages expected{.hashes = {}, .pictures = ExpectedPictures::committed()};
  return judgeImage(image, ScoreSize::small, bestIsa(), entry, expected);
}

class CommittedPictureTest : public testing::TestWithParam<std::string> {};

// Every method on every scene of the small workload, whose image is the committed one where its hash is known. Only
// every fourth entry is rendered by another precision and seed, all of them with WAVECREST_THOROUGH. The number of
// methods is odd, so these entries are of all methods.
TEST_P(CommittedPictureTest, acceptsThePrecisionOfItsImageAndRefusesOthers) {
  static_assert(kScoredMethods % 2 == 1);
  const size_t step = 4 / samples(4, 1);
  const std::vector<ScoreEntry> workload = workloadOf(ScoreSize::small);
  const ImageHashes hashes = ImageHashes::committed();
  for (size_t number = 0; number < workload.size(); ++number) {
    const ScoreEntry& entry = workload[number];
    if (entry.scene != GetParam()) continue;
    SCOPED_TRACE(toString(entry.method));
    const Scene scene = sceneOf(entry);
    const Image own = validatedImage(scene, entry, bestIsa(), 2);
    const std::optional<uint64_t> hash = hashes.find(ScoreSize::small, hashGroup(bestIsa()), entry);
    if (hash) {
      EXPECT_EQ(hashImage(own.pixels), *hash) << "bench/score/remake-hashes build/release/wavecrest";
    }
    EXPECT_EQ(judge(own, entry).validity, Validity::tolerated) << judge(own, entry).text;
    // The same image, brighter or darker by 2 %.
    for (const float factor : {1.02f, 0.98f}) {
      const ImageVerdict lit = judge(scaled(own, factor), entry);
      EXPECT_EQ(lit.validity, Validity::refused) << factor;
      EXPECT_NE(lit.text.find("image: mean off by 2 %, at most 0.3 %"), std::string::npos) << lit.text;
    }
    if (number % step != 0) continue;
    // Rounding: what another compiler or instruction set changes, and more.
    const auto doubled = [](RenderSettings& settings) { settings.precision = Precision::doubled; };
    const ImageVerdict rounded = judge(changedImage(scene, entry, doubled), entry);
    EXPECT_EQ(rounded.validity, Validity::tolerated) << rounded.text;
    // Other random numbers.
    const auto seeded = [](RenderSettings& settings) { settings.seed = 1; };
    const ImageVerdict other = judge(changedImage(scene, entry, seeded), entry);
    EXPECT_EQ(other.validity, Validity::refused) << other.text;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, CommittedPictureTest,
                         testing::Values("cornell-diffuse", "cornell-spheres", "lafortune-room", "pool-interior"),
                         [](const auto& instance) {
                           std::string name = instance.param;
                           name.erase(name.find('-'), 1);
                           return name;
                         });

// Direct light is what paths of two edges add to those of one edge. Subtracting it leaves indirect light.
TEST(ScorePicture, ofAnImageWithoutDirectLightIsRefused) {
  for (const Method method : {Method::pt, Method::lt, Method::bpt, Method::mlt, Method::vcm}) {
    const ScoreEntry entry = entryOf("cornell-diffuse", method);
    const Scene scene = sceneOf(entry);
    const auto upTo = [](uint32_t edges) {
      return [edges](RenderSettings& settings) { settings.limits.maxDepth = edges; };
    };
    Image image = validatedImage(scene, entry, bestIsa(), 2);
    const Image emitters = changedImage(scene, entry, upTo(1)), direct = changedImage(scene, entry, upTo(2));
    for (size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] -= direct.pixels[i] - emitters.pixels[i];
    EXPECT_EQ(judge(image, entry).validity, Validity::refused) << toString(method);
  }
}

// A shorter longest path changes the mean by some percent, and no shadow.
TEST(ScorePicture, ofShorterPathsIsRefused) {
  const ScoreEntry entry = entryOf("cornell-diffuse", Method::pt);
  const Scene scene = sceneOf(entry);
  const auto shorter = [](RenderSettings& settings) { settings.limits.maxDepth = 4; };
  EXPECT_EQ(judge(changedImage(scene, entry, shorter), entry).validity, Validity::refused);
}

// A constant image of the picture's size.
Image flatImage(float value) {
  return {.width = kPictureWidth,
          .height = kPictureHeight,
          .channels = 3,
          .pixels = std::vector<float>(size_t{3} * kPictureWidth * kPictureHeight, value)};
}

TEST(ScorePicture, seesWhatIsWrongInOneBlock) {
  const ScorePicture expected = pictureOf(flatImage(0.25f));
  Image image = flatImage(0.25f);
  // One block, in the third column and second row, is 1.5 times as bright.
  for (size_t y = 8; y < 16; ++y) {
    for (size_t i = 3 * (64 * y + 16); i < 3 * (64 * y + 24); ++i) image.pixels[i] *= 1.5f;
  }
  const PictureDifference difference = differenceOf(pictureOf(image), expected);
  EXPECT_NEAR(difference.worstBlockMeanOff, 0.5, 1e-6);
  EXPECT_NEAR(difference.meanOff, 0.5 / 48, 1e-6);
  EXPECT_FALSE(isWithin(difference, toleranceOf(Method::pt)));
}

TEST(ScorePicture, ofALargerFilmIsItsMeanOverPixels) {
  Image film = flatImage(0.5f);
  film.width *= 2;
  film.height *= 2;
  film.pixels.assign(film.pixels.size() * 4, 0.0f);
  // Every second pixel is white, the others are black: their mean is 0.5.
  for (size_t i = 0; i < film.pixels.size(); i += 6) {
    for (size_t channel = 0; channel < 3; ++channel) film.pixels[i + channel] = 1;
  }
  EXPECT_EQ(pictureOf(film).codes.pixels, pictureOf(flatImage(0.5f)).codes.pixels);
  EXPECT_NEAR(pictureOf(film).blockMeans.back(), 1.5, 1e-6);
}

TEST(ScorePicture, ofNumbersThatAreNotFiniteIsRefused) {
  const ScorePicture expected = pictureOf(flatImage(0.25f));
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    Image image = flatImage(0.25f);
    image.pixels[1000] = bad;
    EXPECT_FALSE(isWithin(differenceOf(pictureOf(image), expected), toleranceOf(Method::mlt)));
  }
}

TEST(ExpectedPictures, areThoseThatWereWritten) {
  const ScoreEntry entry = entryOf("cornell-diffuse", Method::bpt);
  Image image = flatImage(0.0f);
  for (size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = static_cast<float>(i % 251) / 250;
  const ScorePicture picture = pictureOf(image);
  ExpectedPictures pictures;
  pictures.set(ScoreSize::small, entry, picture);
  const ExpectedPictures read = ExpectedPictures::parse(nlohmann::json::parse(pictures.toJson().dump()));
  const ScorePicture* found = read.find(ScoreSize::small, entry);
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(found->codes.pixels, picture.codes.pixels);
  EXPECT_EQ(found->blockMeans, picture.blockMeans);
  EXPECT_EQ(read.find(ScoreSize::large, entry), nullptr);
  EXPECT_EQ(read.find(ScoreSize::small, entryOf("cornell-diffuse", Method::pt)), nullptr);
}

TEST(ExpectedPictures, ofOtherFilesAreRefused) {
  using nlohmann::json;
  EXPECT_THROW(ExpectedPictures::parse(json::array()), ScoreFileError);
  EXPECT_THROW(ExpectedPictures::parse({{"score_version", kScoreVersion + 1}, {"pictures", json::object()}}),
               ScoreFileError);
  ExpectedPictures pictures;
  pictures.set(ScoreSize::small, entryOf("cornell-diffuse", Method::pt), pictureOf(flatImage(0.25f)));
  json file = json::parse(pictures.toJson().dump());
  EXPECT_NO_THROW(ExpectedPictures::parse(file));
  json& picture = file["pictures"]["small"]["cornell-diffuse"]["pt"];
  const std::string codes = picture["codes"];
  for (const json& damaged : {json(codes.substr(4)), json("!" + codes.substr(1)), json(7), json()}) {
    picture["codes"] = damaged;
    EXPECT_THROW(ExpectedPictures::parse(file), ScoreFileError);
  }
}

}  // namespace
}  // namespace wavecrest
