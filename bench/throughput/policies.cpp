#include "bench/throughput/policies.h"

#include <algorithm>
#include <cmath>

#include "bench/throughput/turns.h"

namespace wavecrest {
namespace {

constexpr size_t kFewestRounds = 1, kMostRounds = 7;
// Of the images that are compared. Their difference is rounding, not noise, so few iterations suffice.
constexpr uint64_t kMostIterations = 16;

// Sums over all samples: of the reference, and of an image minus the reference.
struct Sums {
  double value = 0, square = 0, difference = 0, differenceSquare = 0;
};

Sums sumsOf(const std::vector<float>& image, const std::vector<float>& reference) {
  Sums sums;
  for (size_t i = 0; i < image.size(); ++i) {
    const double r = reference[i], d = static_cast<double>(image[i]) - r;
    sums.value += r;
    sums.square += r * r;
    sums.difference += d;
    sums.differenceSquare += d * d;
  }
  return sums;
}

// Sessions for each instruction set, the best first: double, float, and float with the complete kernels where the scene
// chooses others. rows gets one row for each session.
// One thread each: CPU time of threads that share caches would blur the comparison.
std::vector<std::unique_ptr<Session>> makeSessions(const Scene& scene, RenderSettings settings,
                                                   std::vector<PolicyRow>& rows) {
  std::vector<std::unique_ptr<Session>> sessions;
  settings.threads = 1;
  const auto add = [&] {
    sessions.push_back(Session::create(scene, settings));
    rows.push_back({.precision = settings.precision,
                    .isa = settings.isa,
                    .specialization = sessions.back()->statistics().specialization,
                    .pathsPerCpuSecondInterval = {}});
  };
  for (auto isa = availableIsas().rbegin(); isa != availableIsas().rend(); ++isa) {
    for (const Precision precision : {Precision::doubled, Precision::floating}) {
      settings.isa = *isa;
      settings.precision = precision;
      add();
      // Only below the complete kernels is there anything to compare them with.
      if (precision != Precision::floating || rows.back().specialization >= Specialization::complete) continue;
      settings.specialization = Specialization::complete;
      add();
      settings.specialization.reset();
    }
  }
  return sessions;
}

}  // namespace

PolicyTable measurePolicies(const Scene& scene, const RenderSettings& settings, double seconds) {
  PolicyTable table;
  const auto sessions = makeSessions(scene, settings, table.rows);

  // The same whole iterations by all, as many as the slowest can do in half of its share of the time.
  const double share = seconds / static_cast<double>(sessions.size());
  double slowest = 0;
  for (const auto& session : sessions) {
    session->renderUntil(1, std::nullopt);
    slowest = std::max(slowest, session->statistics().renderSeconds);
  }
  table.iterations = std::clamp<uint64_t>(static_cast<uint64_t>(0.5 * share / slowest), 1, kMostIterations);
  for (const auto& session : sessions) session->renderUntil(table.iterations, std::nullopt);
  // The yardstick: double on the best instruction set, which is the first session.
  const std::vector<float> reference = sessions.front()->film().resolve();

  for (size_t i = 0; i < sessions.size(); ++i) {
    const Sums sums = sumsOf(sessions[i]->film().resolve(), reference);
    table.rows[i].meanDifference = sums.value > 0 ? sums.difference / sums.value : 0;
    table.rows[i].pixelDifference = sums.square > 0 ? std::sqrt(sums.differenceSquare / sums.square) : 0;
  }
  // Speeds of the same sessions, in alternating slices.
  const auto slices =
      renderInTurn(sessions, {.seconds = 0.5 * seconds, .fewestRounds = kFewestRounds, .mostRounds = kMostRounds});
  for (size_t i = 0; i < sessions.size(); ++i) {
    const std::vector<double> rates = valuesOf(slices[i], [](const Slice& s) { return s.pathsPerCpuSecond(); });
    table.rows[i].pathsPerCpuSecond = median(rates);
    if (rates.size() >= kVisitsForInterval) table.rows[i].pathsPerCpuSecondInterval = bootstrapMedian(rates);
    table.rows[i].bytesPerPath = sessions[i]->statistics().bytesPerPath;
  }
  return table;
}

}  // namespace wavecrest
