// What a claim asks of one scene's runs: scores and losses by seed, their bands, curves over time, and error slopes.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/statistics/bands.h"
#include "bench/statistics/time_to_loss.h"
#include "wavecrest/results.h"

namespace wavecrest {

// "1 - ssim" and the like: of scores where more is better the distance from the best possible one.
double lossOf(const std::string& metric, double score);
double scoreOfLoss(const std::string& metric, double loss);

// What the study's ppm had its direct light from, which its text leaves open: photons, as in SmallVCM, or next event
// estimation, as in its other methods.
enum class PpmReading { photons, nextEvent };

class SceneLosses {
 public:
  SceneLosses(std::string scene, const CampaignResults& results, PpmReading reading = PpmReading::photons)
      : scene_(std::move(scene)), results_(results), reading_(reading), unbiased_(findUnbiased()) {}
  // Another scene of the same results, read in the same way.
  SceneLosses other(std::string scene) const { return {std::move(scene), results_, reading_}; }

  const std::string& name() const { return scene_; }
  const CampaignResults& results() const { return results_; }

  // The row of the campaign that a claim's method is judged by. The study's MLT mutates paths, so it is mlt-pathspace.
  std::string rowOf(const std::string& method) const;
  // Why a method has no values; empty if it has.
  std::string missing(const std::string& method) const;
  std::vector<const RunRecord*> runs(const std::string& method) const;

  // Whether "rmse", here and below, is the root of kUnbiasedMse, without the noise of the reference. It is where all
  // runs of the scene end with one above 0; else it is RMSE itself.
  bool isUnbiased(const std::string& metric) const { return unbiased_ && metric == "rmse"; }

  // One number of each seed: the score at the end, the logarithm of its loss.
  std::vector<double> scores(const std::string& method, const std::string& metric) const;
  std::vector<double> logLosses(const std::string& method, const std::string& metric) const;

  // mean(a) - mean(b) of the logarithms of the losses of two methods. With one seed the half width, here and in the
  // bands below, comes from how far two seeds of the row are apart in the standard campaign (bench/claims/seed-spread).
  Band lossDifference(const std::string& metric, const std::string& a, const std::string& b) const;
  Band slopeBand(const std::string& method) const;  // of errorSlopes
  Band scoreBand(const std::string& method, const std::string& metric) const;

  // The loss that the reference's own noise gives; nothing where that is not known, and for losses without it.
  std::optional<double> floorLoss(const std::string& metric) const;

  // The logarithm of the time from which on each seed has at most the loss of this logarithm, between snapshots by
  // straight lines over logarithms; of a seed that has more at its end, the logarithm of that. The first snapshot's
  // time where it is there already.
  std::vector<double> logTimes(const std::string& method, const std::string& metric, double wanted) const;

  // d log(loss) / d log(time) of each seed's curve from a quarter of this time to four times it, by least squares;
  // empty where a curve has fewer than three snapshots there.
  std::vector<double> lossSlopes(const std::string& method, const std::string& metric, double seconds) const;

  // When this loss would be reached, by the slope of the runs' own curves; seconds at which they end, a mean.
  std::optional<TimeToLoss> timeToLoss(const std::string& method, const std::string& metric, double loss) const;
  double endSeconds(const std::string& method) const;

  // d log(error) / d log(time) over the last three quarters of the time, by least squares; error is the root of the
  // mean of (T - A)(T - B), in which the reference's noise averages out. Empty where it was not measured.
  std::vector<double> errorSlopes(const std::string& method) const;

 private:
  bool findUnbiased() const;
  // A score of a snapshot; nothing if it was not measured or is not finite.
  std::optional<double> scoreOf(const SnapshotRecord& snapshot, const std::string& metric) const;
  std::vector<double> perSeed(const std::string& method,
                              const std::function<std::optional<double>(const RunRecord&)>& function) const;
  double seedSpread(const std::string& method, const std::string& metric) const;

  std::string scene_;
  const CampaignResults& results_;
  PpmReading reading_;
  bool unbiased_;
};

}  // namespace wavecrest
