// Comparisons of the losses of two methods on one scene: at the end of their runs, in the time to an equal loss, and in
// another scene.
#pragma once

#include <span>
#include <string>

#include "bench/claims/comparison.h"
#include "bench/claims/scene_losses.h"

namespace wavecrest {

// Comparisons that fail for want of time alone are not reached in this time, but those of largerLoss and worseHere
// fail. Not judged: a loss was not measured, or the reference's noise hides the difference.
class LossComparisons {
 public:
  // The scene must outlive it.
  explicit LossComparisons(const SceneLosses& scene) : scene_(scene) {}

  // Whether the loss of `a` is at least `factor` times that of `b`.
  Comparison largerLoss(const std::string& metric, const std::string& a, const std::string& b, double factor) const;
  // Whether the loss of `a` is at most that of `b`.
  Comparison smallerLoss(const std::string& metric, const std::string& a, const std::string& b) const;
  // Whether the loss of `a` is within the factor of that of `b`.
  Comparison notLarger(const std::string& metric, const std::string& a, const std::string& b, double factor) const;
  // Takes the best loss that both methods reach. Compares the time that each needs to get there. Undecided where the
  // slower one has it at a first snapshot, as its time is only an upper bound.
  Comparison faster(const std::string& metric, const std::string& a, const std::string& b) const;
  // Whether `a` is further behind `b` here than in the control, by the factor.
  Comparison worseHere(const std::string& metric, const std::string& a, const std::string& b,
                       const std::string& control, double factor) const;

 private:
  bool nearFloor(const std::string& metric, std::span<const double> logLosses) const;
  double steepness(const std::string& method, const std::string& metric, double seconds) const;
  Comparison withTime(Comparison comparison, const std::string& metric, const std::string& a, const std::string& b,
                      double factor) const;

  const SceneLosses& scene_;
};

}  // namespace wavecrest
