#include "bench/extremes/sweep.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace wavecrest {
namespace {

constexpr double kStandardErrors = 6;  // |t| of 7 degrees of freedom: a false alarm in 2000 rows, and seeds are fixed

// Settings of one render: paths of any length, and fewer chains and bootstraps than by default.
RenderSettings settingsOf(const Sweep& sweep, double value, Method method, Precision precision, uint32_t threads) {
  RenderSettings settings;
  settings.method = method;
  settings.precision = precision;
  settings.isa = bestIsa();
  settings.threads = threads;
  settings.limits = pathLimits(-1, 5);
  settings.metropolis.chains = 512;
  settings.metropolis.bootstrapSamples = 16384;
  if (sweep.adjust) sweep.adjust(value, settings);
  return settings;
}

// All values of a sweep, or the first and the last.
std::vector<double> valuesOf(const Sweep& sweep, bool endsOnly) {
  if (!endsOnly || sweep.values.size() <= 2) return sweep.values;
  return {sweep.values.front(), sweep.values.back()};
}

// Why a row does not pass; empty if it does.
std::string failureOf(const Sweep& sweep, const SweepRow& row) {
  if (!std::isfinite(row.error)) return "the image is not finite";
  if (row.losses.nonFinite != 0) return fmt::format("{} samples were not finite", row.losses.nonFinite);
  if (row.standardError > sweep.resolution) {
    return fmt::format("a standard error of {:.2g} says nothing", row.standardError);
  }
  const double allowed = std::hypot(sweep.bound, kStandardErrors * row.standardError);
  if (std::abs(row.error) > allowed) return fmt::format("{:+.3g} is more than {:.2g}", row.error, allowed);
  return {};
}

// The rows of one method and precision.
void addRows(const Sweep& sweep, Method method, Precision precision, const SweepEffort& effort, SweepResult& out) {
  const auto measureBy = [&](double value, Method by, Precision in) {
    return measureSeeds(sweep.scene(value), settingsOf(sweep, value, by, in, effort.threads), sweep.samples(value),
                        effort.seeds);
  };
  const auto measure = [&](double value) { return measureBy(value, method, precision); };
  // A sweep with neither a known answer nor another method compares its rows with the baseline value.
  std::optional<SeedValues> base;
  if (!sweep.truth && !sweep.against) base = measure(sweep.baseline);
  for (const double value : valuesOf(sweep, effort.endsOnly)) {
    const SeedValues seeds = measure(value);
    SweepRow row{.value = value, .method = method, .precision = precision, .losses = seeds.losses, .failure = {}};
    if (base) {
      // The same seeds at the baseline value: noise that both share cancels.
      const double expected = seedEstimateOf(base->means).mean;
      const SeedEstimate difference =
          seedEstimateOf(differences(seeds, sweep.scale(value) / sweep.scale(sweep.baseline), *base));
      row.error = difference.mean / expected;
      row.standardError = difference.error / std::abs(expected);
    } else if (sweep.against) {
      // Another method in double, with noise of its own.
      const SeedEstimate expected = seedEstimateOf(measureBy(value, *sweep.against, Precision::doubled).means);
      const SeedEstimate estimate = seedEstimateOf(seeds.means);
      row.error = estimate.mean / expected.mean - 1;
      row.standardError = std::hypot(estimate.error, expected.error) / expected.mean;
    } else {
      // A known answer.
      const double expected = sweep.truth(value);
      const SeedEstimate estimate = seedEstimateOf(seeds.means);
      row.error = estimate.mean / expected - 1;
      row.standardError = estimate.error / expected;
    }
    row.failure = failureOf(sweep, row);
    out.rows.push_back(row);
  }
}

}  // namespace

bool SweepResult::passes() const {
  return std::all_of(rows.begin(), rows.end(), [](const SweepRow& row) { return row.failure.empty(); });
}

SweepResult runSweep(const Sweep& sweep, const SweepEffort& effort) {
  SweepResult out{.sweep = &sweep, .rows = {}};
  for (const Precision precision : {Precision::floating, Precision::doubled}) {
    for (const Method method : sweep.methods) addRows(sweep, method, precision, effort, out);
  }
  return out;
}

}  // namespace wavecrest
