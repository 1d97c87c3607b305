// The parts of the list of sweeps (allSweeps), by what they vary, and what the parts share.
#pragma once

#include <functional>
#include <vector>

#include "bench/extremes/sweep.h"

namespace wavecrest {

inline const std::vector<Method> kEveryMethod{Method::pt,  Method::lt,  Method::bpt, Method::mlt,
                                              Method::ppm, Method::bpm, Method::vcm, Method::gpt};

// The same number of samples per pixel for all values.
inline std::function<uint64_t(double)> samples(uint64_t count) {
  return [count](double) { return count; };
}

void addSurfaceSweeps(std::vector<Sweep>& out);
void addLightSweeps(std::vector<Sweep>& out);

}  // namespace wavecrest
