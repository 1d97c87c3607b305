#include "bench/campaign/render_reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "bench/campaign/file_lock.h"
#include "bench/campaign/shrunk_reference.h"
#include "bench/film_image.h"
#include "bench/until/film_error.h"
#include "engine/scene/hash_text.h"
#include "engine/version.h"
#include "metrics/image/atomic_file.h"

namespace wavecrest {
namespace {

// Times are seconds of render time, of both halves together.
constexpr double kSaveSeconds = 30;                       // of render time that a crash may cost
constexpr double kShortestLook = 0.2, kLongestLook = 10;  // seconds between looks at the goal,
constexpr double kLookFraction = 0.1;                     // a part of the time so far
// Iterations of each half before an error counts: of fewer, what is rarely found is missing in both halves.
constexpr uint64_t kFewestIterations = 8;

// The images of halves A and B.
using Halves = std::array<Image, 2>;

// What the file will say of the reference. Methods that do not merge have radius 0.
ReferenceInfo describe(const Scene& scene, const RenderSettings& settings, const std::string& methodReason) {
  const bool merges = strategiesOf(settings.method).merge;
  return {.scene = scene.name,
          .sceneHash = hashText(scene.hash),
          .method = std::string(toString(settings.method)),
          .sampler = std::string(toString(settings.sampler)),
          .precision = std::string(kPrecisionNames[static_cast<size_t>(settings.precision)]),
          .seed = settings.seed,
          // kMostEdges stands for no limit in files.
          .maxDepth = std::min(withinDepthOfMethod(settings).limits.maxDepth, kMostEdges),
          .rouletteDepth = settings.limits.rouletteDepth,
          .radius = merges ? settings.radius.value() : 0,
          .radiusAlpha = merges ? settings.radiusAlpha : 0,
          .methodReason = methodReason,
          .version = kVersion,
          .commit = kCommit};
}

// Throws ReferenceMismatch where the two differ in anything that decides the image in the limit.
void requireSame(const std::filesystem::path& file, const ReferenceInfo& found, const ReferenceInfo& wanted) {
  const auto require = [&](const char* what, const auto& a, const auto& b) {
    if (a == b) return;
    throw ReferenceMismatch(fmt::format("{}: its {} is '{}', not '{}'; expected a reference to go on with, or no file",
                                        file.string(), what, a, b));
  };
  require("scene_hash", found.sceneHash, wanted.sceneHash);
  require("method", found.method, wanted.method);
  require("sampler", found.sampler, wanted.sampler);
  require("precision", found.precision, wanted.precision);
  require("samples", found.samples, wanted.samples);
  require("seed", found.seed, wanted.seed);
  // Files of earlier versions say of mlt what was asked for, which may be more than chains follow.
  const bool chains = found.method == toString(Method::mlt);
  require("max_depth", chains ? std::min(found.maxDepth, kChainDepth) : found.maxDepth, wanted.maxDepth);
  require("roulette_depth", found.rouletteDepth, wanted.rouletteDepth);
  require("radius", found.radius, wanted.radius);
  require("radius_alpha", found.radiusAlpha, wanted.radiusAlpha);
}

// The mean image of n0 + n iterations. before: the mean of the first n0; now: the mean of the other n.
Image joined(const Image& before, uint64_t n0, const Image& now, uint64_t n) {
  if (n0 == 0) return now;
  Image all = now;
  const double part = static_cast<double>(n) / static_cast<double>(n0 + n);
  for (size_t i = 0; i < all.pixels.size(); ++i) {
    all.pixels[i] = static_cast<float>((1 - part) * before.pixels[i] + part * now.pixels[i]);
  }
  return all;
}

// Whether any part of the goal is reached. Without an iteration nothing is.
bool reached(const ReferenceGoal& goal, const Reference& reference) {
  const ReferenceInfo& info = reference.info;
  if (info.iterations == 0) return false;
  const uint64_t fewest = info.relativeError <= kNoVariance ? kBlackIterations : kFewestIterations;
  const bool errorIsKnown = info.iterations >= fewest && !isBlack(reference.mean.pixels);
  return (goal.relativeError && errorIsKnown && info.relativeError <= *goal.relativeError) ||
         (goal.seconds && info.renderSeconds >= *goal.seconds) ||
         (goal.iterations && info.iterations >= *goal.iterations);
}

// Whether an error is the whole goal, and a black image keeps it from being known.
bool neverReached(const ReferenceGoal& goal, const Reference& reference) {
  return !goal.seconds && !goal.iterations && reference.info.iterations >= kBlackIterations &&
         isBlack(reference.mean.pixels);
}

// A pixel that is not finite would stay so, however long the reference goes on. Throws ReferenceMismatch.
void requireFinite(const std::filesystem::path& file, const Reference& reference) {
  for (const Image* image : {&reference.mean, &reference.difference.value()}) {
    const auto count = std::ranges::count_if(image->pixels, [](float value) { return !std::isfinite(value); });
    if (count == 0) continue;
    throw ReferenceMismatch(
        fmt::format("{}: {} of its values are not finite; expected a reference to go on with, or no "
                    "file",
                    file.string(), count));
  }
}

// Iterations until the next look at the goal: no more than the goal leaves, and about a tenth of the time so far,
// within kShortestLook and kLongestLook, so that Ctrl-C does not wait long. done and seconds: of this process.
uint64_t nextIterations(const ReferenceGoal& goal, const ReferenceInfo& info, uint64_t done, double seconds) {
  uint64_t most = std::numeric_limits<uint64_t>::max();
  if (goal.iterations) most = *goal.iterations - info.iterations;
  if (done == 0) return 1;
  double look = std::clamp(kLookFraction * seconds, kShortestLook, kLongestLook);
  if (goal.seconds) look = std::min(look, *goal.seconds - info.renderSeconds);
  // Iterations that fit into that time at the speed so far.
  const double fitting = look * static_cast<double>(done) / std::max(seconds, 1e-6);
  return std::min(most, static_cast<uint64_t>(std::max(1.0, std::round(fitting))));
}

// A session for each half. They begin at the iteration where the stored reference ends, and its images are added in
// collect().
class HalfSessions {
 public:
  HalfSessions(const Scene& scene, const RenderSettings& settings, const Reference& before, const SessionHooks& hooks)
      : firstIteration_(before.info.iterations), firstSeconds_(before.info.renderSeconds) {
    if (firstIteration_ > 0) before_ = {before.halfA(), before.halfB()};
    const IdleScope building(hooks);
    for (size_t half = 0; half < 2; ++half) {
      RenderSettings own = settings;
      own.seed = referenceSeed(settings.seed, half);
      if (settings.method == Method::mlt) {
        // Chains begin at their first step: those that go on are others, with a seed for each iteration to go on from.
        own.seed = referenceSeed(settings.seed ^ static_cast<uint32_t>(firstIteration_ * 0x9e3779b9u), half);
      } else {
        own.firstIteration = firstIteration_;
      }
      sessions_[half] = Session::create(scene, own);
    }
  }

  // Renders both halves, one after the other. False: stopped. Then the halves differ in iterations, so collect() must
  // not be called any more.
  bool render(uint64_t iterations, const ReferenceHooks& hooks) {
    const uint64_t goal = done_ + iterations;
    for (const auto& session : sessions_) {
      bool goesOn = true;
      {
        const WatchScope watch(hooks.session, *session);
        do {
          session->renderUntil(goal, std::nullopt);
        } while (session->interrupted() && (goesOn = hooks.session.goesOn && hooks.session.goesOn()));
      }
      if (!goesOn || (hooks.stopped && hooks.stopped())) return false;
    }
    done_ = goal;
    return true;
  }

  // Puts the halves so far, joined with those of the file, into the reference.
  void collect(Reference& reference) const {
    Halves halves;
    for (size_t half = 0; half < 2; ++half) {
      halves[half] = joined(before_[half], firstIteration_, filmImage(*sessions_[half]), done_);
    }
    reference.info.iterations = firstIteration_ + done_;
    reference.info.renderSeconds = firstSeconds_ + seconds();
    setHalves(reference, halves[0], halves[1]);
  }

  uint64_t done() const { return done_; }
  double seconds() const { return sessions_[0]->progressSeconds() + sessions_[1]->progressSeconds(); }

 private:
  const uint64_t firstIteration_;
  const double firstSeconds_;
  Halves before_;
  std::array<std::unique_ptr<Session>, 2> sessions_;
  uint64_t done_ = 0;
};

}  // namespace

uint64_t referenceSeed(uint64_t seed, size_t half) {
  return (static_cast<uint64_t>(half + 1) << 32) | static_cast<uint32_t>(seed);
}

void beginReference(const Scene& scene, const RenderSettings& settings, const std::filesystem::path& larger,
                    const std::filesystem::path& file) {
  const FileLock lock(file);
  if (std::filesystem::exists(file)) {
    throw ReferenceMismatch(
        fmt::format("{}: exists; expected a new file to begin from {}", file.string(), larger.string()));
  }
  try {
    const Reference shrunk = shrunkReference(readReference(larger), scene);
    requireFinite(larger, shrunk);
    requireSame(larger, shrunk.info, describe(scene, settings, shrunk.info.methodReason));
    writeReference(file, shrunk);
  } catch (const ShrinkError& error) {
    throw ReferenceMismatch(fmt::format("{}: {}", larger.string(), error.what()));
  }
}

Reference renderReference(const Scene& scene, const RenderSettings& settings, const std::string& methodReason,
                          const ReferenceGoal& goal, const std::filesystem::path& file, const ReferenceHooks& hooks) {
  // Begins a new reference, or goes on with the one in the file.
  const ReferenceInfo wanted = describe(scene, settings, methodReason);
  const FileLock lock(file);
  removeTemporaries(file.string());
  Reference reference{.mean = {}, .difference = {}, .info = wanted, .noiseFloors = {}};
  if (std::filesystem::exists(file)) {
    reference = readReference(file);
    if (const std::string wrong = whyNoReference(reference); !wrong.empty()) {
      throw ReferenceMismatch(
          fmt::format("{}: {}; expected a reference to go on with, or no file", file.string(), wrong));
    }
    requireSame(file, reference.info, wanted);
    requireFinite(file, reference);
    // Files of earlier versions have an error by another rule.
    reference.info.relativeError = relativeError(reference.mean, *reference.difference);
    if (reached(goal, reference) || neverReached(goal, reference)) return reference;
    reference.info.maxDepth = wanted.maxDepth;
    reference.info.version = wanted.version;
    reference.info.commit = wanted.commit;
  }
  // Sessions for both halves, and what saving does.
  HalfSessions halves(scene, settings, reference, hooks.session);
  double savedSeconds = reference.info.renderSeconds;
  const auto save = [&] {
    // The noise floors follow from the halves, so they are measured anew.
    measureNoiseFloors(reference);
    writeReference(file, reference);
    savedSeconds = reference.info.renderSeconds;
  };
  // Renders from look to look. Between looks both halves have equal iterations, so any look may save.
  while (!reached(goal, reference) && !neverReached(goal, reference)) {
    if (!halves.render(nextIterations(goal, reference.info, halves.done(), halves.seconds()), hooks)) break;
    halves.collect(reference);
    if (hooks.advance) hooks.advance(reference.info);
    const bool due = reference.info.renderSeconds - savedSeconds >= kSaveSeconds;
    if (due || (hooks.saveNow && hooks.saveNow())) save();
  }
  if (reference.info.iterations > 0 && reference.info.renderSeconds > savedSeconds) save();
  return reference;
}

}  // namespace wavecrest
