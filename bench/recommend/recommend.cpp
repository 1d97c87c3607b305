#include "bench/recommend/recommend.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/film_image.h"
#include "bench/text_lines.h"
#include "engine/inspect/path_classes.h"
#include "engine/scene/scene_error.h"

namespace wavecrest {
namespace {

// Of the render time; the rest is for a longer pilot of the method that comes first. Noise that few paths make is not
// yet what it will be: rare bright pixels spread out, and an SSIM falls behind what a short pilot leads one to expect.
constexpr double kReferencePart = 0.4, kPilotPart = 0.35;
// Unlike any that a user picks; the reference's differ, or its own method would find its own noise in it.
constexpr uint64_t kReferenceSeed = 0x7265666572656e63, kPilotSeed = 0x70696c6f74706963;

// Seconds that a session has rendered, by this clock.
double secondsBy(PilotClock clock, const Session& session, uint32_t threads) {
  const RenderStatistics statistics = session.statistics();
  return clock == PilotClock::wall ? statistics.renderSeconds : statistics.cpuSeconds / threads;
}

// Renders for so many seconds of the clock; returns how many it were. A session stops by wall time, of which others may
// have taken a part.
double renderBy(PilotClock clock, Session& session, uint32_t threads, double seconds) {
  constexpr double kEnough = 0.98;
  for (double done = 0; done < kEnough * seconds; done = secondsBy(clock, session, threads)) {
    session.renderUntil(std::nullopt, session.statistics().renderSeconds + seconds - done);
  }
  return secondsBy(clock, session, threads);
}

// Four renders with seeds from firstSeed on, each for a quarter of the seconds.
Pilot renderPilot(const Scene& scene, RenderSettings settings, uint64_t firstSeed, double seconds, PilotClock clock) {
  Pilot pilot;
  for (size_t part = 0; part < pilot.parts.size(); ++part) {
    settings.seed = firstSeed + part;
    const auto session = Session::create(scene, settings);
    pilot.seconds += renderBy(clock, *session, settings.threads, seconds / static_cast<double>(pilot.parts.size()));
    pilot.parts[part] = filmImage(*session);
  }
  const PathStrategies strategies = strategiesOf(settings.method);
  if (strategies.merge) pilot.biasExponent = biasDecay(settings.radiusAlpha);
  // Where vertices are connected as well, most of what is left is noise of connections.
  if (strategies.merge && !strategies.connect) pilot.noiseExponent = noiseDecay(settings.radiusAlpha);
  return pilot;
}

// Mean of the four, and half the difference of their two halves: the noise of that mean.
struct PilotReference {
  Image mean, noise;
};
PilotReference referenceOf(const Pilot& pilot) {
  PilotReference reference{.mean = pilot.parts[0], .noise = pilot.parts[0]};
  for (size_t i = 0; i < reference.mean.pixels.size(); ++i) {
    const auto at = [&](size_t part) { return static_cast<double>(pilot.parts[part].pixels[i]); };
    reference.mean.pixels[i] = static_cast<float>(0.25 * (at(0) + at(1) + at(2) + at(3)));
    reference.noise.pixels[i] = static_cast<float>(0.25 * (at(0) + at(1) - at(2) - at(3)));
  }
  return reference;
}

// SSIM of the reference with noise added, against the reference itself.
double ssimWithNoise(const PreparedReference& reference, const Image& noise) {
  Image image = linearLight(reference.image().file);
  for (size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] += noise.pixels[i];
  const ComparedImage test = reference.prepareTest("half", {std::move(image), Encoding::linear, {}});
  return reference.ssim().compare(test.codes).mean;
}

// Methods that reach the target come first, by time; the others follow, by their limit.
bool sooner(const RecommendRow& a, const RecommendRow& b) {
  if (a.prediction.seconds && b.prediction.seconds) return *a.prediction.seconds < *b.prediction.seconds;
  if (a.prediction.seconds || b.prediction.seconds) return a.prediction.seconds.has_value();
  return a.prediction.ssimLimit > b.prediction.ssimLimit;
}

std::string duration(double seconds) {
  if (seconds < 100) return fmt::format("{:.2g} s", seconds);
  if (seconds < 6000) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

// The answer in words, with a doubt where the reference is too noisy for the target.
void addParagraph(TextLines& text, const Recommendation& all) {
  const RecommendRow* best = all.best();
  if (best == nullptr) {
    line(text, "{}: no method gets to an SSIM of {:g}; see what each has left in the column 'limit'.", all.scene,
         all.targetSsim);
  } else {
    const Prediction& p = best->prediction;
    line(text, "{}: use {}. It gets to an SSIM of {:g} in about {} ({} to {}).", all.scene, toString(best->method),
         all.targetSsim, duration(*p.seconds), duration(p.interval.low), duration(p.interval.high));
    if (all.rows.size() > 1 && all.rows[1].prediction.seconds) {
      line(text, "Next is {}, which takes {:.1f} times as long.", toString(all.rows[1].method),
           *all.rows[1].prediction.seconds / *p.seconds);
    }
  }
  if (all.referenceSsim < all.targetSsim) {
    line(text,
         "Doubt: the reference that all were compared with ({}) is itself known to an SSIM of {:.3f} only; "
         "try a longer --budget.",
         toString(all.referenceMethod), all.referenceSsim);
  }
}

}  // namespace

const RecommendRow* Recommendation::best() const {
  return rows.empty() || !rows.front().prediction.seconds ? nullptr : &rows.front();
}

Recommendation recommend(const Scene& scene, const RenderSettings& settings, const RecommendRequest& request) {
  Recommendation result{.scene = scene.name, .targetSsim = request.targetSsim, .rows = {}};
  // The reference, by the method that `inspect` names, and its own noise.
  RenderSettings own = settings;
  own.method = result.referenceMethod = classifyPaths(scene).reference.method;
  const PilotReference halves =
      referenceOf(renderPilot(scene, own, kReferenceSeed, kReferencePart * request.seconds, request.clock));
  const PreparedReference reference("reference", {halves.mean, Encoding::linear, {}});
  result.referenceSsim = ssimWithNoise(reference, halves.noise);
  const auto predictRow = [&](RecommendRow& row, double seconds) {
    own.method = row.method;
    const Pilot pilot = renderPilot(scene, own, kPilotSeed, seconds, request.clock);
    row.pilotSeconds = pilot.seconds;
    row.prediction = predict(reference, halves.noise, pilot, request.targetSsim);
  };
  // A short pilot of each method.
  for (const Method method : request.methods) {
    RecommendRow& row = result.rows.emplace_back();
    row.method = method;
    try {
      predictRow(row, kPilotPart * request.seconds / static_cast<double>(request.methods.size()));
    } catch (const SceneError& error) {
      row.refusal = error.what();
    }
  }
  std::stable_sort(result.rows.begin(), result.rows.end(), sooner);
  // A longer pilot of the method that is first. The prediction may change, and the order with it.
  if (!result.rows.empty() && result.rows.front().refusal.empty()) {
    predictRow(result.rows.front(), (1 - kReferencePart - kPilotPart) * request.seconds);
    std::stable_sort(result.rows.begin(), result.rows.end(), sooner);
  }
  return result;
}

std::string toText(const Recommendation& all) {
  TextLines text;
  addParagraph(text, all);
  line(text, "\n{:<7} {:>10} {:>21} {:>9} {:>7} {:>9}", "method", "time", "interval", "SSIM now", "limit", "pilot s");
  for (const RecommendRow& row : all.rows) {
    const Prediction& p = row.prediction;
    // A method that was refused has the reason in place of figures.
    if (!row.refusal.empty()) {
      line(text, "{:<7} {}", toString(row.method), row.refusal);
      continue;
    }
    const std::string time = p.seconds ? duration(*p.seconds) : "never";
    const std::string interval =
        p.seconds ? fmt::format("{} to {}", duration(p.interval.low), duration(p.interval.high)) : "";
    line(text, "{:<7} {:>10} {:>21} {:>9.4f} {:>7.4f} {:>9.2f}", toString(row.method), time, interval, p.ssimNow,
         p.ssimLimit, row.pilotSeconds);
  }
  return fmt::to_string(text);
}

nlohmann::ordered_json toJson(const Recommendation& all) {
  using Json = nlohmann::ordered_json;
  // null stands for a method that does not reach the target.
  const auto secondsJson = [](const Prediction& p) { return p.seconds ? Json(*p.seconds) : Json(); };
  const auto intervalJson = [](const Prediction& p) {
    return p.seconds ? Json({p.interval.low, p.interval.high}) : Json();
  };
  Json table = Json::array();
  for (const RecommendRow& row : all.rows) {
    Json entry = {{"method", std::string(toString(row.method))}};
    if (!row.refusal.empty()) {
      entry["refused"] = row.refusal;
    } else {
      entry.update({{"predicted_seconds", secondsJson(row.prediction)},
                    {"interval", intervalJson(row.prediction)},
                    {"ssim_now", row.prediction.ssimNow},
                    {"ssim_limit", row.prediction.ssimLimit},
                    {"pilot_seconds", row.pilotSeconds}});
    }
    table.push_back(entry);
  }
  const RecommendRow* best = all.best();
  return {{"scene", all.scene},
          {"target_ssim", all.targetSsim},
          {"method", best == nullptr ? Json() : Json(std::string(toString(best->method)))},
          {"predicted_seconds", best == nullptr ? Json() : secondsJson(best->prediction)},
          {"interval", best == nullptr ? Json() : intervalJson(best->prediction)},
          {"interval_level", kIntervalLevel},
          {"reference_method", std::string(toString(all.referenceMethod))},
          {"reference_ssim", all.referenceSsim},
          {"table", table}};
}

}  // namespace wavecrest
