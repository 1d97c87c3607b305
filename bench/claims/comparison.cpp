#include "bench/claims/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace wavecrest {
namespace {

using V = ClaimVerdict;

// Those that hold come first, by how clearly they do; those that fail come last.
bool isClearer(const Comparison& x, const Comparison& y) {
  return x.verdict != y.verdict ? x.verdict < y.verdict : x.margin > y.margin;
}

}  // namespace

std::string plusMinus(double halfWidth) {
  return std::isfinite(halfWidth) && halfWidth > 0 ? fmt::format(" \u00b1 {:.2g}", halfWidth) : "";
}

Comparison above(const Band& band, double limit, std::string text) {
  const double margin = band.mean - limit;
  const V verdict = margin >= band.halfWidth ? V::holds : margin < -band.halfWidth ? V::fails : V::undecided;
  return {verdict, margin, std::move(text)};
}
Comparison below(const Band& band, double limit, std::string text) {
  return above({-band.mean, band.halfWidth}, -limit, std::move(text));
}

Comparison negated(Comparison c) {
  c.margin = -c.margin;
  if (c.verdict == V::holds || c.verdict == V::fails) c.verdict = c.verdict == V::holds ? V::fails : V::holds;
  return c;
}

Comparison best(const std::vector<Comparison>& all) { return *std::min_element(all.begin(), all.end(), isClearer); }
Comparison worst(const std::vector<Comparison>& all) { return *std::max_element(all.begin(), all.end(), isClearer); }
Comparison middle(std::vector<Comparison> all) {
  std::sort(all.begin(), all.end(), isClearer);
  return all[all.size() / 2];
}

std::string secondsText(double seconds) {
  return seconds < 100 ? fmt::format("{:.3g} s", seconds) : fmt::format("{:.0f} s", seconds);
}

std::string nameOf(const std::string& metric) {
  if (metric == "ssim") return "SSIM";
  if (metric == "q_mos") return "Q_MOS";
  return metric == "rmse" ? "RMSE" : metric;
}

double meanOfLog(std::span<const double> values) { return std::exp(meanBand(values).mean); }

}  // namespace wavecrest
