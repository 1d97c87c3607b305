#include "engine/trials/choose_method.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "engine/pilot/finished_plan.h"
#include "engine/pilot/merge_radius.h"
#include "engine/trials/trial_error.h"
#include "engine/waves/wave_session.h"

namespace wavecrest {
namespace {

constexpr uint64_t kTrialSeed = 0x747269616c73;
constexpr double kTrialPixels = 64 * 48;  // of the trial image, at most
constexpr uint32_t kTrialWave = 2048, kTrialPieces = 8;

// A round renders two images of so many iterations each. Then candidates with more than `within` times the least
// inefficiency stop.
struct Round {
  uint64_t iterations;
  double within;
};

// The trials of a method.
struct Trials {
  std::span<const Method> candidates;  // the last one is taken where none finds light
  std::span<const Round> rounds;
  bool independent;  // samples are independent, whatever the render's own sampler
};
// evcm: vcm, the last one, has all strategies.
constexpr std::array kStrategies{Method::pt, Method::lt, Method::bpt, Method::vcm};
constexpr std::array kStrategyRounds{Round{1, 8}, Round{4, 4}, Round{16, 1}};
// gpt: a guide may cost more than it brings. The two images have a Sobol run each, so they are independent.
constexpr std::array kGuides{Method::pt, Method::gpt};
constexpr std::array kGuideRounds{Round{kSobolRun, 1}};

Trials trialsOf(Method method) {
  if (method == Method::gpt) return {.candidates = kGuides, .rounds = kGuideRounds, .independent = false};
  return {.candidates = kStrategies, .rounds = kStrategyRounds, .independent = true};
}

// What gpt learns in before its rounds: whole blocks, so that the rounds are the next block.
constexpr uint64_t kLearningIterations = 2 * kSobolRun;

// Costs in units of one closest-hit ray with its shading: least squares of CPU times of 16 scenes by six methods (AMD
// EPYC Zen 5, AVX-512), with residuals of 4 and 8 %. kSmallCosts: for Accel::small, whose rays are cheap.
struct Costs {
  double shadow, connection, merge, path;
  double guide;  // of each ray of a method with a guide
};
constexpr Costs kCosts{.shadow = 0.67, .connection = 0.2, .merge = 0.2, .path = 0, .guide = 0.3};
constexpr Costs kSmallCosts{.shadow = 0.7, .connection = 0.93, .merge = 1.57, .path = 0.8, .guide = 1};
// Variance of independent over Sobol samples, mean of the nine scenes, for methods that gain by Sobol. Trials of evcm
// draw independent samples, so that the two images of a round are independent.
constexpr double kSobolGain = 1.15;
// What a method's variance is multiplied by for the error that trials do not see: the bias of merges, or the caustics
// of methods without light paths, most of whose variance comes from paths that 42 samples seldom include. The guide of
// a render learns from more paths than that of a trial.
double unseenError(Method method) {
  if (method == Method::gpt) return 0.85;
  const PathStrategies strategies = strategiesOf(method);
  if (strategies.merge) return 1.1;
  return strategies.camera || strategies.connect ? 1 : 1.25;
}

uint64_t pixelsOf(const FilmSettings& film) { return uint64_t{film.imageWidth()} * film.imageHeight(); }

FilmSettings scaledFilm(FilmSettings film, double scale) {
  const auto scaled = [scale](uint32_t size) { return static_cast<uint32_t>(std::lround(scale * size)); };
  film.width = std::max(scaled(film.width), 1u);
  film.height = std::max(scaled(film.height), 1u);
  if (!film.isCropped()) return film;
  film.cropX = std::min(scaled(film.cropX), film.width - 1);
  film.cropY = std::min(scaled(film.cropY), film.height - 1);
  film.cropWidth = std::clamp(scaled(film.cropWidth), 1u, film.width - film.cropX);
  film.cropHeight = std::clamp(scaled(film.cropHeight), 1u, film.height - film.cropY);
  return film;
}

// The settings on a scaled film, with light paths in proportion.
RenderSettings onScaledFilm(RenderSettings settings, const FilmSettings& film, double scale) {
  settings.film = scaledFilm(film, scale);
  if (settings.lightPaths) {
    const double share = static_cast<double>(pixelsOf(*settings.film)) / static_cast<double>(pixelsOf(film));
    const double wanted = share * static_cast<double>(*settings.lightPaths);
    settings.lightPaths = static_cast<uint64_t>(std::clamp(wanted, 1.0, static_cast<double>(kMostPaths)));
  }
  return settings;
}

template <class S>
RenderSettings trialSettings(const Scene& scene, const RenderSettings& settings, Method method,
                             const std::shared_ptr<const CompiledScene<S>>& compiled) {
  const FilmSettings& film = scene.film;
  RenderSettings own = withMethod(settings, method);
  own.memoryBytes.reset();  // of the render, which may be smaller than a usual film
  const double scale = std::min(std::sqrt(kTrialPixels / static_cast<double>(pixelsOf(film))), 1.0);
  RenderSettings trial = onScaledFilm(own, film, scale);
  // Under wider filters the paths of an iteration share one place in their pixels, which two images tell little of.
  trial.film->filter = ReconstructionFilter::box;
  trial.film->filterRadius = FilmSettings().filterRadius;
  if (strategiesOf(method).merge) {
    // As many pixels as on a usual film, so that searches see as many photons as there. Under a crop these are as few
    // as in the render, which has a light path for each pixel of the crop and the radius of the whole film.
    const double usualScale = std::sqrt(kUsualFilm / (static_cast<double>(film.width) * film.height));
    const RenderSettings usual = onScaledFilm(own, film, usualScale);
    const RenderPlan<S> plan = finishedPlan<S>(scene, usual, filmArea(*usual.film), compiled);
    trial.radius = plan.mergeRadius.first * usualScale / scale;
  }
  trial.seed = kTrialSeed;
  if (trialsOf(settings.method).independent) trial.sampler = SamplerKind::independent;
  trial.share = {};
  trial.firstIteration = 0;
  trial.iterations.reset();
  trial.seconds.reset();
  trial.waveSize = kTrialWave;
  trial.piecesForThreads = kTrialPieces;
  return trial;
}

struct Candidate {
  Method method;
  std::unique_ptr<Session> session;
  bool goesOn = true;
};

// Renders so many more iterations; returns the image of these alone.
std::vector<float> nextImage(Session& session, uint64_t iterations) {
  const uint64_t before = session.statistics().iterations;
  std::vector<float> sums = before == 0 ? std::vector<float>{} : session.film().resolve();
  session.renderUntil(before + iterations, std::nullopt);
  std::vector<float> image = session.film().resolve();
  for (size_t i = 0; i < sums.size(); ++i) {
    const double all = static_cast<double>(before + iterations) * image[i] - static_cast<double>(before) * sums[i];
    image[i] = static_cast<float>(all / static_cast<double>(iterations));
  }
  return image;
}

double costOf(const RenderStatistics& statistics) {
  const StageCounters& counts = statistics.counters;
  const Costs& costs = statistics.accel == Accel::small ? kSmallCosts : kCosts;
  const double ray = statistics.guide ? 1 + costs.guide : 1;
  const double rays =
      ray * static_cast<double>(counts.raysClosest) + costs.shadow * static_cast<double>(counts.raysShadow) +
      costs.connection * static_cast<double>(counts.connections) + costs.merge * static_cast<double>(counts.merges);
  return rays / static_cast<double>(statistics.paths) + costs.path;
}

// images: of each candidate.
std::vector<MethodTrial> resultsOf(const std::vector<Candidate>& candidates, const std::vector<TrialImages>& images,
                                   SamplerKind sampler) {
  const std::vector<TrialError> errors = trialErrors(images);
  std::vector<MethodTrial> trials;
  for (size_t i = 0; i < candidates.size(); ++i) {
    const Candidate& candidate = candidates[i];
    const RenderStatistics statistics = candidate.session->statistics();
    const bool gains = statistics.sampler != sampler && bestSampler(candidate.method) == sampler;
    trials.push_back({.method = candidate.method,
                      .iterations = images[i].iterations(),
                      .variance = errors[i].variance * unseenError(candidate.method) / (gains ? kSobolGain : 1),
                      .missed = errors[i].missed,
                      .cost = costOf(statistics)});
  }
  return trials;
}

// Renders all rounds. The times of the choice are not set.
template <class S>
MethodChoice runTrials(const Scene& scene, const RenderSettings& settings,
                       const std::shared_ptr<const CompiledScene<S>>& compiled) {
  std::vector<Candidate> candidates;
  std::vector<TrialImages> images;
  const Trials kind = trialsOf(settings.method);
  for (const Method method : kind.candidates) {
    const RenderSettings trial = trialSettings<S>(scene, settings, method, compiled);
    candidates.push_back({method, makeWaveSession<S>(scene, trial, {.scene = compiled})});
    if (method == Method::gpt) candidates.back().session->renderUntil(kLearningIterations, std::nullopt);
    const FilmArea& area = candidates.back().session->film().area();
    images.emplace_back(area.width, area.height);
  }
  std::vector<MethodTrial> trials;
  for (const Round& round : kind.rounds) {
    for (size_t i = 0; i < candidates.size(); ++i) {
      if (!candidates[i].goesOn) continue;
      const std::vector<float> first = nextImage(*candidates[i].session, round.iterations);
      images[i].add(first, nextImage(*candidates[i].session, round.iterations), round.iterations);
    }
    trials = resultsOf(candidates, images, settings.sampler);
    const double best = bestOf(trials).inefficiency();
    for (size_t i = 0; i < trials.size(); ++i) {
      candidates[i].goesOn &= trials[i].inefficiency() <= round.within * best;
    }
    if (std::ranges::count_if(candidates, &Candidate::goesOn) < 2) break;
  }
  // If no candidate found any light, take the one with all strategies.
  const bool dark = std::ranges::none_of(images, [](const TrialImages& one) { return one.brightness() > 0; });
  return {.method = dark ? kind.candidates.back() : bestOf(trials).method, .trials = std::move(trials)};
}

}  // namespace

const MethodTrial& bestOf(std::span<const MethodTrial> trials) {
  return *std::ranges::min_element(trials, [](const MethodTrial& a, const MethodTrial& b) {
    if (a.iterations != b.iterations) return a.iterations > b.iterations;
    return a.inefficiency() < b.inefficiency();
  });
}

RenderSettings withMethod(RenderSettings settings, Method method) {
  settings.method = method;
  if (settings.guide == GuideTarget::automatic) settings.guide = GuideTarget::radiance;
  // Sobol points that were not chosen, only where they serve the method.
  if (!settings.samplerIsChosen && settings.sampler == SamplerKind::sobol) settings.sampler = bestSampler(method);
  if (!strategiesOf(method).merge) settings.lightPaths.reset();
  return settings;
}

template <class S>
Prepared<S> chooseMethod(const Scene& scene, const RenderSettings& settings) {
  Prepared<S> prepared;
  prepared.buildSeconds = timeBuilding(settings, [&] {
    oneapi::tbb::task_arena arena(static_cast<int>(settings.threads));
    arena.execute([&] { prepared.scene = compileScene<S>(scene, settings.accel, true, settings.instancing); });
  });
  const auto begin = Clock::now();
  const double cpuBegin = processCpuSeconds();
  prepared.choice = runTrials<S>(scene, settings, prepared.scene);
  prepared.choice->seconds = secondsSince(begin);
  prepared.choice->cpuSeconds = processCpuSeconds() - cpuBegin;
  return prepared;
}
template Prepared<float> chooseMethod(const Scene&, const RenderSettings&);
template Prepared<double> chooseMethod(const Scene&, const RenderSettings&);

}  // namespace wavecrest
