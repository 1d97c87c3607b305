#include "cli/inspect_guide.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

#include "cli/file_check.h"
#include "cli/messages.h"
#include "engine/session/session.h"
#include "library/errors.h"
#include "library/option_values.h"
#include "metrics/image/image_io.h"

namespace wavecrest {
namespace {

constexpr uint32_t kWidth = 256, kHeight = 128;

std::array<uint32_t, 2> parsePixel(const std::string& text, uint32_t width, uint32_t height) {
  const auto pixel = parsePair(text, ',');
  if (pixel && (*pixel)[0] < width && (*pixel)[1] < height) return *pixel;
  throw UsageError(
      fmt::format("--guide '{}': no pixel of the image; expected X,Y up to {},{}", text, width - 1, height - 1));
}

// The left edge is -z, a quarter of the width from it is +x; the top is +y.
std::array<double, 3> directionOf(uint32_t x, uint32_t y) {
  const double phi = (x + 0.5) / kWidth * 2 * std::numbers::pi;
  const double theta = (y + 0.5) / kHeight * std::numbers::pi;
  return {std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
}

Image pictureOf(const LearnedDirections& learned) {
  Image picture{.width = kWidth, .height = kHeight, .channels = 1, .pixels = {}};
  for (uint32_t y = 0; y < kHeight; ++y) {
    for (uint32_t x = 0; x < kWidth; ++x) {
      picture.pixels.push_back(static_cast<float>(learned.density(directionOf(x, y))));
    }
  }
  return picture;
}

}  // namespace

void writeGuidePicture(const Scene& scene, RenderSettings settings, const GuideOptions& options) {
  const auto [x, y] = parsePixel(options.pixel, scene.film.imageWidth(), scene.film.imageHeight());
  const double seconds = parseDuration("--time", options.time.empty() ? "10s" : options.time);
  const std::string file = options.output.empty() ? scene.name + ".guide.exr" : options.output;
  FileCheck files;
  for (const std::string& input : scene.files) files.input("the scene", input);
  files.image("-o", file);
  settings.method = Method::gpt;
  if (settings.guide == GuideTarget::automatic) settings.guide = GuideTarget::radiance;
  settings.sampler = bestSampler(settings);
  const std::unique_ptr<Session> session = Session::create(scene, settings);
  session->renderUntil(std::nullopt, seconds);
  const std::optional<LearnedDirections> learned = session->learnedDirections(x, y);
  if (!learned) throw InputError(fmt::format("--guide {},{}: sees no rough surface; expected a pixel that does", x, y));
  Image picture = pictureOf(*learned);
  const float greatest = *std::max_element(picture.pixels.begin(), picture.pixels.end());
  printOut(
      "pixel {},{}: cell {} of {}, after {} iterations; the guide draws {:.0f} % of directions, at most {:.3g} a "
      "steradian\n",
      x, y, learned->cell, learned->cells, session->statistics().iterations, 100 * learned->guidedShare, greatest);
  if (extensionOf(file) == ".png" && greatest > 0) {
    for (float& value : picture.pixels) value /= greatest;
  }
  writeImage(file, picture);
}

}  // namespace wavecrest
