// What a scene means rather than how its file says it: features that change no image are removed.
//
// Kernels are specialised by feature sets, and each feature is paid for by every vertex. Files often name features that
// they do not use: exporters write a normal for each corner of a flat face, a texture of one colour, an opacity of one.
#pragma once

#include "engine/scene/scene.h"

namespace wavecrest {

// Removes, in place:
//  - vertex normals of a mesh where all of them equal the normals of their faces up to kFlatCosine;
//  - textures of one colour, which become that colour; bump maps of one height, normal maps that map to the normal;
//  - opacities of one.
void simplifyScene(Scene& scene);

// The cosine between a vertex normal and its face's from which they are the same: the rounding of files that write six
// digits stays above it (an angle of 0.0014).
constexpr double kFlatCosine = 1 - 1e-6;

}  // namespace wavecrest
