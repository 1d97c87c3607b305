#include "bench/recommend/pilot_renders.h"

#include <algorithm>

#include "bench/film_image.h"

namespace wavecrest {
namespace {

constexpr double kParts = 4;
// Of a render by chains: each epoch begins with a bootstrap, which takes 4 to 7 % of it (engine/chains/README.md).
constexpr double kBootstrapPart = 0.06;
constexpr uint64_t kFewestForPace = 4;  // iterations from which the time of one is told without that of the first

// Seconds that a session has rendered, by this clock.
double secondsBy(ClockKind clock, const Session& session, uint32_t threads) {
  const RenderStatistics statistics = session.statistics();
  return clock == ClockKind::wall ? statistics.renderSeconds : statistics.cpuSeconds / threads;
}

// Renders for so many more seconds of wall time, or until the session has these iterations. False if it stopped before
// that time: it has its iterations, or another step of its chains would not end in time.
bool renderFor(Session& session, std::optional<uint64_t> iterations, double seconds) {
  const double end = session.statistics().renderSeconds + seconds;
  session.renderUntil(iterations, end);
  return session.statistics().renderSeconds >= end;
}

// One part: an image, how long it took, and how long it would take within a long render.
struct Part {
  std::optional<Image> image;
  double seconds = 0, pace = 0;
};

Part renderPart(const Scene& scene, const RenderSettings& settings, double seconds, ClockKind clock) {
  const auto session = Session::create(scene, settings);
  const auto now = [&] { return secondsBy(clock, *session, settings.threads); };
  // The first whole image, if it comes in time. What comes before it is done once in a render.
  const double limit = kMostOverrun * seconds;
  while (!session->statistics().hasWholeImage() && now() < limit) {
    if (!renderFor(*session, 1, limit - now())) break;
  }
  Part part;
  const uint64_t first = session->statistics().iterations;
  const double firstSeconds = part.seconds = now();
  if (first == 0) return part;
  renderBy(clock, *session, settings.threads, seconds);
  part.image = filmImage(*session);
  part.seconds = part.pace = now();
  const uint64_t all = session->statistics().iterations;
  if (all >= first + kFewestForPace) {
    part.pace = static_cast<double>(all) * (part.seconds - firstSeconds) / static_cast<double>(all - first);
    if (settings.method == Method::mlt) part.pace *= 1 + kBootstrapPart;
  }
  return part;
}

}  // namespace

void renderBy(ClockKind clock, Session& session, uint32_t threads, double seconds) {
  constexpr double kEnough = 0.98;
  for (double done = secondsBy(clock, session, threads); done < kEnough * seconds;
       done = secondsBy(clock, session, threads)) {
    if (!renderFor(session, std::nullopt, seconds - done)) break;
  }
}

RenderSettings pilotSettings(RenderSettings settings, Method method) {
  settings.method = method;
  settings.sampler = bestSampler(settings);
  return settings;
}

RenderSettings referenceSettings(const RenderSettings& settings, const ReferenceChoice& choice) {
  RenderSettings own = pilotSettings(settings, choice.method);
  if (choice.biased) own.radius = kFixedRadius;
  return own;
}

PilotRender renderPilot(const Scene& scene, RenderSettings settings, uint64_t firstSeed, double seconds,
                        ClockKind clock, bool biased) {
  PilotRender result;
  Pilot pilot{.parts = {}, .biased = biased};
  for (size_t i = 0; i < pilot.parts.size(); ++i) {
    settings.seed = firstSeed + i;
    Part part = renderPart(scene, settings, seconds / kParts, clock);
    result.seconds += part.seconds;
    result.needed = std::max(result.needed, kParts * part.seconds);
    if (!part.image) return result;
    pilot.parts[i] = std::move(*part.image);
    pilot.seconds += part.pace;
    pilot.onceSeconds += std::max(part.seconds - part.pace, 0.0) / kParts;
  }
  const PathStrategies strategies = strategiesOf(settings.method);
  if (strategies.merge) pilot.biasExponent = biasDecay(settings.radiusAlpha);
  // Where vertices are connected as well, most of what is left is noise of connections.
  if (strategies.merge && !strategies.connect) pilot.noiseExponent = noiseDecay(settings.radiusAlpha);
  result.pilot = std::move(pilot);
  return result;
}

}  // namespace wavecrest
