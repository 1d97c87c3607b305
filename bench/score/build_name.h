// What rounds: the program's version, its compiler and its Embree. Images of builds of equal names have equal bits.
#pragma once

#include <string>

namespace wavecrest {

std::string compilerName();  // "GCC 12.2.0"
std::string buildName();     // "0.1.0, GCC 12.2.0, Embree 3.13.5"

}  // namespace wavecrest
