// CPU time of each stage of a pipeline over whole waves.
//
// A session times its stages by the time-stamp counter, which goes on while another program has the core. Here every
// call is timed in CPU time, at a cost that a render would not want, and that is subtracted again.
#pragma once

#include <cstdint>
#include <vector>

#include "bench/throughput/wave_capture.h"

namespace wavecrest {

class StageTimes {
 public:
  // Precision float or fast.
  StageTimes(const Scene& scene, const RenderSettings& settings);

  // False for a method with light paths or chains, whose stages need what a session has built before them: such a
  // method cannot be measured here.
  bool possible() const { return capture_.tracesWholeMethod(); }

  // Traces waves from all over the film until `seconds` have passed, at least one of them, and adds their times.
  void measureFor(double seconds);

  // CPU time that a path takes in a stage, in pipeline order, over everything measured; once measureFor() was called.
  double secondsPerPath(size_t stage) const { return seconds_[stage] / static_cast<double>(paths_); }

 private:
  WaveCapture<float> capture_;
  Wave<float> wave_;
  size_t nextWave_ = 0;
  uint64_t paths_ = 0;
  std::vector<double> seconds_;  // per stage
};

}  // namespace wavecrest
