// The version, compiler and Embree of this build: all that its rounding depends on. Builds with the same name render
// the same bits on the same instruction set.
#pragma once

#include <string>

namespace wavecrest {

std::string compilerName();  // "GCC 12.2.0"
std::string buildName();     // "0.1.0, GCC 12.2.0, Embree 3.13.5"

}  // namespace wavecrest
