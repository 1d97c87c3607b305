// Textures and the environment map in the form kernels read.
#pragma once

#include <vector>

#include "engine/scene/scene.h"
#include "kernels/scene_view.h"

namespace wavecrest {

struct Textures {
  std::vector<TextureRecord> records;  // in the order of scene.textures
  std::vector<float> texels;           // RGB of all bitmaps; one that several textures share is stored once
};
// Throws SceneError where bitmaps have more texels than kernels can index.
Textures compileTextures(const Scene& scene);

// The environment map and its sampling distribution: texels by the luminance around them times their solid angle, so
// that no texel whose interpolated radiance is positive has probability zero.
struct Environment {
  std::vector<float> texels, probability;
  std::vector<AliasEntry> table;
  double meanLuminance = 0;  // over the sphere
  EnvironmentView view;      // into the above; width 0 without a map
};
// Throws SceneError, at `where`, where the map has more texels than kernels can index.
Environment compileEnvironment(const EnvmapEmitter& emitter, const SourceLocation& where = {});

}  // namespace wavecrest
