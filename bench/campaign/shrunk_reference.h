// A reference of a small film from one of a larger film. With the box filter a pixel's true value is the mean of the
// pixels that it covers of the larger film, so one long render serves both.
#pragma once

#include <stdexcept>

#include "bench/campaign/reference_file.h"
#include "engine/scene/scene.h"

namespace wavecrest {

// The larger one cannot be shrunk to the scene's film. The text begins with what is wrong and says what was expected.
struct ShrinkError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// scene: as it is for the small film. The result is what a render of the small film would have come to: halves are the
// means of the larger halves, an iteration of k times the width counts as k^2, and rendering can go on from it.
// Throws ShrinkError where the larger one is of another scene, is compact, merges (its radius is that of its own
// iterations) or is not a multiple of the film in both directions alike, and where the filter is not the box.
Reference shrunkReference(const Reference& larger, const Scene& scene);

}  // namespace wavecrest
