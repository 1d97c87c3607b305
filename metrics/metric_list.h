// The metrics, in one list: how each is called, what it needs, which of its numbers counts and how it is computed.
//
// The command line, campaigns and reports read this list; a new metric is one entry in metric_list.cpp.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "metrics/prepared_reference.h"

namespace wavecrest {

struct Score {
  std::string_view name;  // empty: the metric's only number
  double value;
};

struct Measurement {
  std::vector<Score> scores;
  std::vector<float> map;  // badness of each pixel, 0 = none; empty unless asked for
};

// What a metric sees of an image.
enum class MetricInput {
  values,        // as read, or with --gamma as 8-bit codes
  codes,         // 8-bit sRGB, exposed
  exposedLight,  // linear light, exposed
  lightAsRead    // linear light, whatever the exposure
};

struct Metric {
  std::string_view name;     // "ssim": of --metrics and of JSON keys
  std::string_view symbol;   // for axes and table heads: "SSIM"
  std::string_view title;    // for people
  std::string_view basis;    // what it looks at, for people
  MetricInput input;         // the same, for options that change it
  std::string_view formula;  // of test x and reference r, or who defined it
  std::string_view score;    // name of the score that curves and thresholds use; empty: the only one
  bool higherIsBetter;
  double sampleExponent;       // the score of a mean of n independent images goes as n to this; 0: by no power law
  std::string_view threshold;  // its command-line option: "min-ssim"
  bool byDefault;              // measured when no metric is named
  uint32_t smallestSide;       // images with a shorter side are refused
  double mapRange;             // value of the map that false colours show brightest; 0: its 99.9 % quantile
  Measurement (*measure)(const PreparedReference& reference, const ComparedImage& test, bool withMap);
  std::string_view conditions = {};  // version, display and viewing that scores depend on, for people
};

std::span<const Metric> metricList();

// The entry of that name, or null.
const Metric* findMetric(std::string_view name);

// What a score is called where scores of all metrics lie side by side: "rmse", "relmse_trimmed", "ssim" (its mean),
// "ssim_r", "q_mos", "q". Scores of a metric whose main score has a name of its own stand under their names alone.
std::string scoreName(const Metric& metric, std::string_view score);

// The score that counts.
double mainScore(const Metric& metric, const Measurement& measurement);

}  // namespace wavecrest
