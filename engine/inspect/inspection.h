// What wavecrest makes of a scene, as plain data: what is in it, which kernels and intersector it gets, how much memory
// each method takes and which paths each can make. Nothing is rendered.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/inspect/path_classes.h"
#include "engine/plan/memory_use.h"
#include "engine/plan/merge_radius.h"
#include "engine/plan/render_settings.h"

namespace wavecrest {

struct MethodInspection {
  Method method = Method::pt;
  std::string refusal;  // why the method cannot render the scene; empty: it can, and the rest is filled in
  Specialization specialization{};
  MemoryPlan memory;
  std::optional<MergeRadius> mergeRadius;  // as of DryPlan
};

struct SceneInspection {
  // How many of each kind, by the names of Mitsuba's plugins; wrappers such as twosided count, too.
  std::map<std::string, size_t> bsdfs, lights, textures;
  std::string sensor, filter;
  std::vector<std::string> needs;  // what the scene asks of its kernels, in words
  PrimitiveCounts primitives;      // copies of instances among them, or those of each group once
  size_t groups = 0, instances = 0;
  bool keepsInstances = false;   // rather than make copies of them
  size_t hierarchyNodes = 0;     // of `bvh`: 0 if all primitives are in one leaf, and for other intersectors
  double bytesPerPrimitive = 0;  // its record and attributes, and its share of the hierarchy
  BoundingSphere bounds;
  Accel accel{};
  std::vector<MethodInspection> methods;  // in the order of kMethods
  PathClassTable paths;
};

// settings: what decides kernels, memory, the radius of merges or the path classes counts, as precision, accel,
// instancing, wave size, threads, radius, chains, the budget of memory and the longest path; the method does not, and
// the sampler does only if it is chosen. Throws std::runtime_error where no method can render the scene.
SceneInspection inspectScene(const Scene& scene, RenderSettings settings);

}  // namespace wavecrest
