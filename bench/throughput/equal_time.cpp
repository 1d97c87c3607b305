#include "bench/throughput/equal_time.h"

#include <algorithm>

#include "bench/film_image.h"
#include "engine/inspect/path_classes.h"
#include "metrics/rmse.h"

namespace wavecrest {
namespace {

constexpr uint64_t kReferenceSeeds[] = {0x9e3779b97f4a7c15u, 0xbf58476d1ce4e5b9u};  // unlike any a user picks

ErrorAtTime errorNow(const Session& session, const NoisyReference& reference) {
  const RenderStatistics statistics = session.statistics();
  ErrorAtTime point{.seconds = statistics.renderSeconds,
                    .cpuSeconds = statistics.cpuSeconds,
                    .samplesPerPixel = static_cast<double>(statistics.paths) /
                                       static_cast<double>(session.film().area().pixels.size())};
  point.relmse = std::max(relmse(reference.image, filmImage(session)).relmse - reference.noise, 0.0);
  if (point.relmse > 0) point.efficiency = 1 / (point.relmse * point.cpuSeconds);
  return point;
}

}  // namespace

NoisyReference renderReference(const Scene& scene, const RenderSettings& settings, double seconds) {
  RenderSettings own = settings;
  const ReferenceChoice choice = classifyPaths(scene).reference;
  own.method = choice.method;
  own.sampler = bestSampler(own.method);
  Image halves[2];
  for (size_t i = 0; i < 2; ++i) {
    own.seed = kReferenceSeeds[i];
    const auto session = Session::create(scene, own);
    session->renderUntil(std::nullopt, seconds / 2);
    session->renderUntil(1, std::nullopt);  // a whole image, however long that takes
    halves[i] = filmImage(*session);
  }
  NoisyReference reference{
      .method = own.method, .biased = choice.biased, .image = halves[0], .noise = 0, .seconds = seconds};
  for (size_t i = 0; i < reference.image.pixels.size(); ++i) {
    reference.image.pixels[i] = 0.5f * (halves[0].pixels[i] + halves[1].pixels[i]);
  }
  // The mean is half their distance away from each half: relMSE against the mean is the expected error of the mean.
  reference.noise = relmse(reference.image, halves[0]).relmse;
  return reference;
}

std::vector<ErrorRow> measureEqualTime(const Scene& scene, const RenderSettings& settings,
                                       const std::vector<Method>& methods, const NoisyReference& reference,
                                       double seconds) {
  std::vector<ErrorRow> rows;
  std::vector<std::unique_ptr<Session>> sessions;
  for (const Method method : methods) {
    for (const SamplerKind sampler : kAllSamplerKinds) {
      RenderSettings own = settings;
      own.method = method;
      own.sampler = sampler;
      sessions.push_back(Session::create(scene, own));
      rows.push_back({.method = method, .sampler = sampler, .points = {}});
    }
  }
  for (const double part : {0.25, 0.5, 1.0}) {
    for (size_t i = 0; i < sessions.size(); ++i) {
      sessions[i]->renderUntil(std::nullopt, part * seconds);
      sessions[i]->renderUntil(1, std::nullopt);  // a whole image, whose time is told
      rows[i].points.push_back(errorNow(*sessions[i], reference));
    }
  }
  return rows;
}

}  // namespace wavecrest
