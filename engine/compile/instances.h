// Instances of groups of shapes: whether kernels get copies of a group's primitives in world space, or the group once
// and a hierarchy of two levels.
//
// Copies cost memory and nothing else, so they are made where they are few: no more than kMostCopies primitives beyond
// one copy of each group.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "engine/scene/scene.h"

namespace wavecrest {

// small: a loop over all primitives, for small scenes. bvh: our own hierarchy, for all others. embree: what bvh is
// measured against, and an independent check of it.
enum class Accel { automatic, embree, small, bvh };
constexpr std::array<std::string_view, 4> kAccelNames{"auto", "embree", "small", "bvh"};

// automatic: by the rule above. expanded, kept: copies, or two levels, whatever it says.
enum class Instancing { automatic, expanded, kept };
constexpr std::array<std::string_view, 3> kInstancingNames{"auto", "expand", "keep"};

constexpr uint64_t kMostCopies = 100'000;

// Whether the scene gets two levels. Throws SceneError where what is asked for cannot be: copies of a sphere that an
// instance scales differently along its axes, or two levels for an intersector other than `bvh`.
bool keepsInstances(const Scene& scene, Accel accel, Instancing instancing);

}  // namespace wavecrest
