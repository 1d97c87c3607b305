// The teapot of veach-door: a turned body with lid and knob, a handle and a spout. It stands on y = 0, is 0.316 high,
// has its spout towards +x and its handle towards -x.
#pragma once

#include "scenes/generate/mesh.h"

namespace wavecrest::generate {

// For metal and glaze: one body, with handle and spout reaching into it.
Mesh makeOpaqueTeapot();

// For glass: a closed outer and a closed inner surface 6 mm apart, and solid handle and spout whose ends follow the
// body at a distance of 0.4 mm. No two pieces of glass overlap, so every ray crosses air and glass in turn.
Mesh makeGlassTeapot();

}  // namespace wavecrest::generate
