// What a convergence report says, as plain data: scenes x methods x seeds x snapshots, every snapshot with every
// metric. Filled by collect.h from results, turned into a page by html_page.h, into a table by csv.h and into plot
// files by plot_files.h; none of them knows where the data came from. Everything that is indexed by metric is parallel
// to ConvergenceReport::metrics.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bench/report/picture_crop.h"

namespace wavecrest {

/// A quality measure, and how its axis is drawn.
struct ReportMetric {
  std::string key = {};          ///< as in `compare --metrics`, e.g. "rmse"
  std::string name = {};         ///< heading, e.g. "RMSE"
  std::string explanation = {};  ///< one line under the heading
  std::string formula = {};      ///< of test x and reference r, or who defined it
  bool higherIsBetter = false;
  bool logarithmic = true;
  /// Exponent of time at which the error of an unbiased method falls; drawn as a guide.
  std::optional<double> idealSlope = {};
  /// A score that people ask "how long until" about; drawn as a line.
  std::optional<double> target = {};
  /// The score of an image without error, where one is known that curves approach as a power of time.
  std::optional<double> best = {};
};

struct NamedValue {
  std::string name, value;
};

struct NamedNumber {
  std::string name = {};
  double value;
};

/// One measured snapshot.
struct ReportPoint {
  unsigned number = 0;  ///< of the snapshot, from 0 on; the first whole image of a run may have a later one
  double seconds = 0;   ///< render clock
  uint64_t iterations = 0;
  std::vector<double> values = {};        ///< per metric; NaN where it was not measured
  std::vector<NamedNumber> further = {};  ///< other scores, for exports: those of single channels, for example
};

/// One run from start to end; points in order of time.
struct ReportRun {
  uint64_t seed = 0;
  std::vector<ReportPoint> points = {};
};

/// Work of one pipeline stage, summed over threads.
struct ReportStage {
  std::string name = {};
  uint64_t items = 0;
  double seconds = 0;
};

/// 8-bit sRGB pixels, row by row from the top left, three bytes each.
struct ReportImage {
  std::string label = {};
  uint32_t width = 0, height = 0;
  std::vector<uint8_t> rgb = {};
  std::string floats = {};  ///< the light behind the codes (float_image.h); empty where it is not known
};

/// Where the error of a snapshot comes from, known where several seeds were rendered: mean squares over pixels, without
/// the reference's own noise. bias2 may come out slightly negative.
struct ReportBias {
  double seconds = 0;
  size_t seeds = 0;
  double meanSquareError = 0, variance = 0, bias2 = 0;
};

/// One method with one choice of settings on one scene: its runs (one per seed) and what they cost.
struct ReportSeries {
  std::string method = {};
  std::string label = {};  ///< the method, and what tells two series of one method apart
  std::vector<ReportRun> runs = {};
  double pathsPerSecond = 0;                    ///< mean over runs
  double cpuSeconds = 0;                        ///< sum over runs
  std::vector<ReportStage> stages = {};         ///< sum over runs
  std::vector<NamedValue> settings = {};        ///< sampler, precision, radius, ...
  ReportImage finalImage = {};                  ///< of the first run that ended with one; without pixels if none did
  ReportImage errorMap = {};                    ///< of that image against the reference, in false colours
  std::vector<ReportImage> earlierImages = {};  ///< per ReportScene::earlierSeconds; without pixels where none is known
  std::vector<ReportBias> bias = {};            ///< in order of time; empty with a single seed
};

/// What a scene asks of methods: a class of paths, and what each method makes of it ("sampled", "impossible", ...).
struct ReportPathClass {
  std::string name = {};
  std::vector<NamedValue> verdicts = {};  ///< by method
};

struct ReportScene {
  std::string name = {};
  uint32_t width = 0, height = 0;
  ReportImage reference = {};
  std::string referenceOrigin = {};                     ///< how the reference was made, one line
  std::vector<std::optional<double>> noiseFloors = {};  ///< per metric: score of a perfect image, where known
  std::string errorMapScale = {};                       ///< what the colours of the error maps mean, one line
  double errorMapRange = 0;                             ///< value of the brightest colour; 0: there are no maps
  std::vector<PictureCrop> crops = {};                  ///< that the campaign asks readers to look at
  std::vector<double> earlierSeconds = {};              ///< times before the end at which pictures are shown, rising
  std::vector<ReportSeries> series = {};
  std::vector<ReportPathClass> pathClasses = {};
  std::vector<NamedValue> refusals = {};  ///< methods that cannot render this scene, and why
};

/// A statement of the study and whether it holds here.
struct ReportClaim {
  std::string scene, statement;
  std::string verdict = {};  ///< "holds", "does not hold", "not reached in this time", "undecided" or "not judged"
  std::string figure = {};   ///< in some ten words: what decides it, or why it is not judged
  std::string evidence = {};
  std::string source = {};       ///< the study's words
  std::string explanation = {};  ///< why it does not hold or is open, where somebody has written that down
  bool explainedHere = true;     ///< of this campaign, and not of one with the same verdict
  std::string id = {};           ///< in bench/claims
};

struct ConvergenceReport {
  std::string title = {};
  std::vector<std::string> remarks = {};  ///< what a reader must know first: noisy references, unequal runs
  std::vector<ReportMetric> metrics = {};
  std::vector<ReportScene> scenes = {};
  std::vector<ReportClaim> claims = {};
  std::vector<NamedValue> environment = {};
  std::string baseline = {};  ///< method that speed-ups are over; empty: the first
};

}  // namespace wavecrest
