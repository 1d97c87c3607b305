// The scene's <integrator>: path and roulette depth, and a note on the method it stands for.
#pragma once

#include "engine/load/context.h"

namespace wavecrest {

// Wrappers (moment, aov, …) are read through to the integrator within them.
void readIntegrator(LoadContext& context, const XmlElement& integrator);

}  // namespace wavecrest
