// A sweep: one property of a scene or a render, taken to its extremes, and what the image must stay.
//
// Each row is a method, a precision and a value of the property. Its image's mean is compared with a known answer, or
// with the same method's image at a value that is no extreme, or with another method's. A row passes if it is off by no
// more than the sweep's bound and six standard errors of its own, all samples are finite, and it is not too noisy to
// tell.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/extremes/measure.h"

namespace wavecrest {

struct Sweep {
  std::string name;    // as in a file name
  std::string title;   // what is varied, in words
  std::string xLabel;  // of the value
  std::vector<double> values;
  std::function<Scene(double)> scene;
  // What the mean of the image is known to be; none: what it is at `baseline`, times scale(value) / scale(baseline).
  std::function<double(double)> truth = nullptr;
  double baseline = 1;
  std::function<double(double)> scale = [](double) { return 1.0; };
  std::optional<Method> against = std::nullopt;  // what this method's image is at the same value, in double
  double bound = 1e-4;                           // relative
  std::string boundSource;                       // why this much is allowed
  std::vector<Method> methods = {};
  std::string leftOut = {};  // why methods that are not listed cannot have rows
  std::function<void(double, RenderSettings&)> adjust = nullptr;
  std::function<uint64_t(double)> samples = [](double) { return uint64_t{16}; };  // of a pixel
  bool everyRun = false;     // its ends are tested in every run, not on request alone
  double resolution = 0.02;  // largest relative standard error with which a row still says something
};

// All sweeps: those that move geometry once for each intersector.
std::vector<Sweep> allSweeps();

struct SweepRow {
  double value = 0;
  Method method = Method::pt;
  Precision precision = Precision::floating;
  double error = 0, standardError = 0;  // relative to the expected value
  Losses losses;
  std::string failure;  // empty where the row passes
};
struct SweepResult {
  const Sweep* sweep = nullptr;
  std::vector<SweepRow> rows;
  bool passes() const;
};

// How much is measured: a test takes the ends of each sweep, a report all of it.
struct SweepEffort {
  bool endsOnly = false;
  size_t seeds = 8;
  uint32_t threads = 1;
};
SweepResult runSweep(const Sweep& sweep, const SweepEffort& effort);

}  // namespace wavecrest
