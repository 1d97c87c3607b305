#include "bench/specialization/specialization.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "bench/throughput/turns.h"
#include "engine/film/film.h"
#include "engine/plan/render_plan.h"

namespace wavecrest {
namespace {

constexpr size_t kFewestRounds = 7, kMostRounds = 31;
constexpr uint64_t kMostIterations = 16;
constexpr double kImagePart = 0.3;  // of the time, for the images that are compared

struct FeatureName {
  Feature bit;
  const char* name;
};
// One name for each bit of Feature. The assertion fails for a new bit without a name.
constexpr FeatureName kFeatureNames[] = {{kSpecularBsdfs, "specular BSDFs"},
                                         {kLayeredBsdfs, "layered BSDFs"},
                                         {kTextures, "textures"},
                                         {kShadingNormals, "shading normals"},
                                         {kCurvedShapes, "spheres"},
                                         {kRareLights, "rare lights"},
                                         {kBidirectional, "light paths"},
                                         {kNormalMaps, "normal maps"},
                                         {kCompoundBsdfs, "compound BSDFs"},
                                         {kInstances, "instances"}};
static_assert(kAllFeatures >> std::size(kFeatureNames) == 0 && kAllFeatures >> (std::size(kFeatureNames) - 1) == 1);

std::vector<std::string> namesOf(uint32_t features) {
  std::vector<std::string> names;
  for (const FeatureName& feature : kFeatureNames) {
    if ((features & feature.bit) != 0) names.emplace_back(feature.name);
  }
  return names;
}

// The feature sets that are compiled and cover these features. The last one is `complete`, which has all features.
std::vector<Specialization> covering(uint32_t features, Precision precision) {
  std::vector<Specialization> sets;
  for (size_t i = 0; i < kSpecializationCount; ++i) {
    const auto set = static_cast<Specialization>(i);
    if (isCompiled(precision, set) && (features & ~featuresOf(set)) == 0) sets.push_back(set);
  }
  return sets;
}

// The image after so many iterations.
std::vector<float> render(const Scene& scene, const RenderSettings& settings, uint64_t iterations) {
  const auto session = Session::create(scene, settings);
  session->renderUntil(iterations, std::nullopt);
  return session->film().resolve();
}

// Root mean square of the difference over samples, relative to the root mean square of the reference.
double relativeDifference(const std::vector<float>& image, const std::vector<float>& reference) {
  double square = 0, difference = 0;
  for (size_t i = 0; i < image.size(); ++i) {
    square += std::pow(static_cast<double>(reference[i]), 2);
    difference += std::pow(static_cast<double>(image[i]) - static_cast<double>(reference[i]), 2);
  }
  return square > 0 ? std::sqrt(difference / square) : 0;
}

// Images of all sets with each seed, one set's after another's, compared with the last set's.
void compareImages(const Scene& scene, const std::vector<RenderSettings>& settings, SpecializationResult& result) {
  std::vector<std::vector<BlockMeans>> blocks(settings.size());
  for (uint32_t seed = 0; seed < kSpecializationSeeds; ++seed) {
    const auto imageOf = [&](size_t i) {
      RenderSettings own = settings[i];
      own.seed = seed;
      return render(scene, own, result.iterations);
    };
    // The image of the last set, with which the others of this seed are compared.
    const std::vector<float> complete = imageOf(settings.size() - 1);
    for (size_t i = 0; i < settings.size(); ++i) {
      const std::vector<float> image = i + 1 < settings.size() ? imageOf(i) : complete;
      FeatureSetRow& row = result.rows[i];
      // Every seed must give the same bits. The pixel difference is the largest of all seeds.
      row.sameBits = (seed == 0 || row.sameBits) && image == complete;
      row.pixelDifference = std::max(row.pixelDifference, relativeDifference(image, complete));
      blocks[i].push_back(blockMeans(image, result.width));
    }
  }
  // Verdicts on the mean and on the blocks, for each set but the last, share the level (Bonferroni).
  const auto verdicts = 2 * static_cast<double>(std::max<size_t>(settings.size() - 1, 1));
  for (size_t i = 0; i < settings.size(); ++i) {
    FeatureSetRow& row = result.rows[i];
    const BlockComparison compared = comparePaired(blocks[i], blocks.back());
    row.mean = compared.mean;
    row.worstBlock = compared.worstBlock;
    for (const Bias& bias : {row.mean, row.worstBlock}) {
      row.differs |= bias.probability < kSpecializationLevel / verdicts && std::abs(bias.value) > kNegligibleBias;
    }
  }
}

// Renders with all sets in turn. Speed-ups are over the last set, round by round.
void measureSpeeds(const Scene& scene, const std::vector<RenderSettings>& settings, double seconds,
                   SpecializationResult& result) {
  std::vector<std::unique_ptr<Session>> sessions;
  sessions.reserve(settings.size());
  for (const RenderSettings& own : settings) sessions.push_back(Session::create(scene, own));
  MachineWatch watch;
  const auto slices = renderInTurn(
      sessions, {.seconds = seconds, .fewestRounds = kFewestRounds, .mostRounds = kMostRounds}, [&] { watch.look(); });
  const auto rate = [](const Slice& slice) { return slice.pathsPerCpuSecond(); };
  const std::vector<double> complete = valuesOf(slices.back(), rate);
  for (size_t i = 0; i < sessions.size(); ++i) {
    std::vector<double> rates = valuesOf(slices[i], rate);
    result.rows[i].pathsPerCpuSecond = estimateMedian(rates);
    // Over the last set's rate in the same round.
    for (size_t k = 0; k < rates.size(); ++k) rates[k] /= complete[k];
    result.rows[i].speedup = estimateMedian(rates);
    result.rows[i].bytesPerPath = sessions[i]->statistics().bytesPerPath;
  }
  result.machine = watch.state();
}

}  // namespace

const FeatureSetRow& SpecializationResult::chosen() const {
  return *std::find_if(rows.begin(), rows.end(), [](const FeatureSetRow& row) { return row.chosen; });
}

bool SpecializationResult::anyDiffers() const {
  return std::any_of(rows.begin(), rows.end(), [](const FeatureSetRow& row) { return row.differs; });
}

SpecializationResult measureSpecialization(const Scene& scene, const RenderSettings& base, double seconds) {
  const FilmArea area = filmArea(scene.film);
  const uint32_t features = featuresNeeded(scene, base);
  SpecializationResult result{.scene = scene.name,
                              .method = base.method,
                              .width = area.width,
                              .height = area.height,
                              .needs = namesOf(features),
                              .rows = {},
                              .machine = {}};
  // A row for each feature set, with what is known before rendering.
  const Specialization chosen = chooseSpecialization(features, base.precision);
  std::vector<RenderSettings> settings;
  for (const Specialization set : covering(features, base.precision)) {
    RenderSettings& own = settings.emplace_back(base);
    own.specialization = set;
    own.threads = 1;
    result.rows.push_back({.specialization = set,
                           .chosen = set == chosen,
                           .paysFor = namesOf(featuresOf(set) & ~features),
                           .pathsPerCpuSecond = {},
                           .speedup = {},
                           .mean = {},
                           .worstBlock = {}});
  }
  // As many iterations as the part of the time for images allows, judged by one iteration of the last set.
  const auto session = Session::create(scene, settings.back());
  session->renderUntil(1, std::nullopt);
  // Each set renders one image for each seed.
  const double images = static_cast<double>(settings.size() * kSpecializationSeeds);
  const double affordable = kImagePart * seconds / (images * std::max(session->statistics().renderSeconds, 1e-6));
  result.iterations = static_cast<uint64_t>(std::clamp(affordable, 1.0, static_cast<double>(kMostIterations)));
  // Images first, then speeds in the rest of the time.
  compareImages(scene, settings, result);
  measureSpeeds(scene, settings, (1 - kImagePart) * seconds, result);
  return result;
}

}  // namespace wavecrest
