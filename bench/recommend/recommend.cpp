#include "bench/recommend/recommend.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/recommend/duration_words.h"
#include "bench/score_text.h"
#include "bench/statistics/biased_reference.h"
#include "bench/statistics/chains_mislead.h"
#include "engine/inspect/path_classes.h"
#include "engine/scene/scene_error.h"

namespace wavecrest {
namespace {

// Of the render time; the rest is for a longer pilot of the method that comes first. Noise that few paths make is not
// yet what it will be: rare bright pixels spread out, and an SSIM falls behind what a short pilot leads one to expect.
constexpr double kReferencePart = 0.4, kPilotPart = 0.35;
// Unlike any that a user picks; the reference's differ, or its own method would find its own noise in it.
constexpr uint64_t kReferenceSeed = 0x7265666572656e63, kPilotSeed = 0x70696c6f74706963;

// The widest interval that is called an answer: its ends are a factor of the square root away from the middle.
constexpr double kWidestInterval = 4;

// Methods that reach the target come first, by time; the others follow, by their limit; last those not told.
bool sooner(const RecommendRow& a, const RecommendRow& b) {
  if (a.told != b.told) return a.told;
  if (a.prediction.seconds && b.prediction.seconds) return *a.prediction.seconds < *b.prediction.seconds;
  if (a.prediction.seconds || b.prediction.seconds) return a.prediction.seconds.has_value();
  return a.prediction.ssimLimit > b.prediction.ssimLimit;
}

// The classes of paths that a method does not sample, separated by commas.
std::string unsampled(const PathClassTable& table, Method method) {
  std::string classes;
  for (const PathClass& entry : table.classes) {
    if (table.verdict(entry, method) != Verdict::impossible) continue;
    classes += (classes.empty() ? "" : ", ") + entry.signature;
  }
  return classes;
}

// The next budget that is easily said, in seconds.
double roundBudget(double seconds) {
  for (const double round : {20.0, 60.0, 120.0, 300.0, 600.0, 1200.0, 1800.0}) {
    if (seconds <= round) return round;
  }
  return 3600 * std::ceil(seconds / 3600);
}

}  // namespace

const RecommendRow* Recommendation::best() const {
  return rows.empty() || !untold.empty() || !rows.front().prediction.seconds ? nullptr : &rows.front();
}

void judgeRows(Recommendation& all) {
  std::stable_sort(all.rows.begin(), all.rows.end(), sooner);
  const RecommendRow* const first =
      all.rows.empty() || !all.rows.front().prediction.seconds ? nullptr : &all.rows.front();
  // Without whole images of the reference, or of a method that may be the best, there is no verdict.
  double longest = 0;
  for (const RecommendRow& row : all.rows) {
    if (row.told || !row.refusal.empty()) continue;
    longest = std::max(longest, row.needed);
    if (first != nullptr && first->prediction.interval.high < row.needed / 4) continue;  // one image takes longer
    if (all.untold.empty()) all.untold = fmt::format("{} has no whole images by then", toString(row.method));
  }
  if (!all.untold.empty()) {
    all.suggestedBudget =
        roundBudget(std::max(longest * static_cast<double>(all.rows.size()) / kPilotPart, 2 * all.budget));
    return;
  }
  if (first == nullptr) return;
  // The interval of the best one is part of the verdict.
  const Interval interval = first->prediction.interval;
  if (!(interval.high <= kWidestInterval * interval.low)) {
    all.untold = std::isfinite(interval.high)
                     ? fmt::format("{} may take {} or {}", toString(first->method), durationWords(interval.low),
                                   durationWords(interval.high))
                     : fmt::format("the reference of {} is too noisy", toString(all.referenceMethod));
    all.suggestedBudget = roundBudget(4 * all.budget);
    return;
  }
  for (const RecommendRow& row : all.rows) {
    if (&row == first || !row.prediction.seconds) continue;
    if (row.prediction.interval.low > *first->prediction.seconds) continue;
    all.doubts.push_back(fmt::format("{} may be as soon, in {} at the earliest", toString(row.method),
                                     durationWords(row.prediction.interval.low)));
  }
  if (first->method == Method::mlt) all.doubts.emplace_back(kChainsMislead);
  if (all.referenceSsim < all.targetSsim) {
    all.doubts.push_back(
        fmt::format("the reference that all were compared with ({}) is itself known to an SSIM of {} only",
                    toString(all.referenceMethod),
                    scoreBesideTarget(all.referenceSsim, all.targetSsim, true, 3, Digits::decimals)));
  }
}

Recommendation recommend(const Scene& scene, const RenderSettings& settings, const RecommendRequest& request) {
  Recommendation result{.scene = scene.name, .targetSsim = request.targetSsim, .budget = request.seconds};
  // The reference, by the method that `inspect` names.
  const PathClassTable classes = classifyPaths(scene);
  result.referenceMethod = classes.reference.method;
  if (classes.reference.biased) result.doubts.push_back(referenceBlurs(result.referenceMethod));
  const PilotRender rendered = renderPilot(scene, referenceSettings(settings, classes.reference), kReferenceSeed,
                                           kReferencePart * request.seconds, request.clock, false);
  if (!rendered.pilot) {
    result.untold = fmt::format("the reference, by {}, has no whole images by then", toString(result.referenceMethod));
    result.suggestedBudget = roundBudget(std::max(rendered.needed / kReferencePart, 2 * request.seconds));
    return result;
  }
  const PilotReference reference(*rendered.pilot);
  result.referenceSsim = reference.ssim;
  const auto predictRow = [&](RecommendRow& row, double seconds) {
    const bool biased = strategiesOf(row.method).merge || !row.leavesOut.empty();
    const PilotRender pilot =
        renderPilot(scene, pilotSettings(settings, row.method), kPilotSeed, seconds, request.clock, biased);
    row.pilotSeconds = pilot.seconds;
    row.needed = pilot.needed;
    row.told = pilot.pilot.has_value();
    if (row.told) row.prediction = predict(reference, *pilot.pilot, request.targetSsim);
  };
  // A short pilot of each method. One without rivals gets the time of the longer pilot at once.
  const bool alone = request.methods.size() == 1;
  const double pilotPart = alone ? 1 - kReferencePart : kPilotPart / static_cast<double>(request.methods.size());
  for (const Method method : request.methods) {
    RecommendRow& row = result.rows.emplace_back();
    row.method = method;
    row.leavesOut = unsampled(classes, method);
    try {
      predictRow(row, pilotPart * request.seconds);
    } catch (const SceneError& error) {
      row.refusal = error.what();
    }
  }
  std::stable_sort(result.rows.begin(), result.rows.end(), sooner);
  // A longer pilot of the method that is first. The prediction may change, and the order with it.
  if (!alone && !result.rows.empty() && result.rows.front().told) {
    predictRow(result.rows.front(), (1 - kReferencePart - kPilotPart) * request.seconds);
  }
  judgeRows(result);
  return result;
}

}  // namespace wavecrest
