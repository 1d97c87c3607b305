// Which method renders an image that is left to trials (engine/trials/choose_method.h).
#pragma once

#include <cstdint>
#include <vector>

#include "engine/methods/method_list.h"

namespace wavecrest {

// What trials found about one candidate. Variances are those of a pixel's mean over one iteration, over the squared
// brightness there, in the mean over the trial image.
struct MethodTrial {
  Method method{};
  uint64_t iterations = 0;  // of the trial image
  double variance = 0;      // seen
  double missed = 0;        // at least: of light that other candidates found and this one did not
  double cost = 0;          // of a pixel's iteration, in rays

  // What a render's error falls with: the squared error times the work that it took.
  double inefficiency() const { return (variance + missed) * cost; }
};

struct MethodChoice {
  Method method{};
  std::vector<MethodTrial> trials;
  double seconds = 0, cpuSeconds = 0;  // that trials took; a session's clock begins with them
};

}  // namespace wavecrest
