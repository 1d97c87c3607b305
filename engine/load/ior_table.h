// Named substances: indices of refraction of dielectrics and complex indices of conductors.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "engine/scene/scene.h"

namespace wavecrest {

// Names are Mitsuba's; letter case does not matter.
std::optional<double> findIor(std::string_view substance);
std::string listIorNames();

struct ComplexIor {
  Rgb eta, k;
};
// Names are Mitsuba's data files (Al, Au, Cu, …); letter case matters.
std::optional<ComplexIor> findConductor(std::string_view material);
std::string listConductorNames();

}  // namespace wavecrest
