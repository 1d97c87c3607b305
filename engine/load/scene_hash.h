// A 64-bit fingerprint of everything in a Scene that can change an image.
#pragma once

#include "engine/scene/scene.h"

namespace wavecrest {

// Names, ids, source locations and warnings do not count, nor where a texture or mesh was read from. The value is the
// same on every run and machine, so results can be filed under it.
uint64_t hashScene(const Scene& scene);

}  // namespace wavecrest
