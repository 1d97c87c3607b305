#include "bench/claims/comparison.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace wavecrest {

std::string plusMinus(double halfWidth) {
  return std::isfinite(halfWidth) && halfWidth > 0 ? fmt::format(" \u00b1 {:.2g}", halfWidth) : "";
}

int weightOf(ClaimVerdict verdict) {
  switch (verdict) {
    case ClaimVerdict::fails:
      return 4;
    case ClaimVerdict::notReached:
      return 3;
    case ClaimVerdict::notJudged:
      return 2;
    case ClaimVerdict::undecided:
      return 1;
    case ClaimVerdict::holds:
      break;
  }
  return 0;
}

Comparison above(const Band& band, double limit, std::string text) {
  const double margin = band.mean - limit;
  const ClaimVerdict verdict = margin >= band.halfWidth   ? ClaimVerdict::holds
                               : margin < -band.halfWidth ? ClaimVerdict::fails
                                                          : ClaimVerdict::undecided;
  return {verdict, margin, std::move(text)};
}
Comparison below(const Band& band, double limit, std::string text) {
  return above({-band.mean, band.halfWidth}, -limit, std::move(text));
}

std::string nameOf(const std::string& metric) {
  if (metric == "ssim") return "SSIM";
  if (metric == "q_mos") return "Q_MOS";
  return metric == "rmse" ? "RMSE" : metric;
}

double meanOfLog(std::span<const double> values) { return std::exp(meanBand(values).mean); }

}  // namespace wavecrest
