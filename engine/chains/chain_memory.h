// The memory of Markov chains, for plans and for sessions.
#pragma once

#include "engine/memory_plan.h"

namespace wavecrest {

// Adds what the chains of a plan take, and what `workers` threads take that advance them: waves, light vertices and
// splats. Exact.
template <class S>
void addChainMemory(const RenderPlan<S>& plan, const RenderSettings& settings, size_t pixels, size_t workers,
                    MemoryUse& use);

}  // namespace wavecrest
