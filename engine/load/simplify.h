// What a scene means rather than how its file says it: features that change no image are removed.
//
// Kernels are specialised by feature sets, and each feature is paid for by every vertex. Files often name features that
// they do not use: exporters write a normal for each corner of a flat face, a texture of one colour, an opacity of one.
#pragma once

#include "engine/scene/scene.h"

namespace wavecrest {

// Removes, in place:
//  - vertex normals of a mesh where all of them equal the normals of their faces up to kFlatSine2;
//  - textures of one colour, which become that colour; bump maps of one height, normal maps that map to the normal;
//  - opacities of one;
//  - parts of blends that have no weight, or are black where light passes no other part.
void simplifyScene(Scene& scene);

// The squared sine of the angle between a vertex normal and its face's up to which they are the same: an angle of
// 1.4e-5. The rounding of files that write six digits stays below 2e-12; a mesh of many triangles that is gently curved
// does not.
constexpr double kFlatSine2 = 2e-10;

}  // namespace wavecrest
