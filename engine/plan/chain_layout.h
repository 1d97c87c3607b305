// How the chains of a render lie in waves, and what they keep there.
#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/plan/pipeline.h"
#include "engine/plan/render_settings.h"
#include "kernels/columns/chains.h"

namespace wavecrest {

// Which chain goes to which wave.
//
// Chains are numbered in the order of their first paths' lengths. A wave of the longest paths takes several times as
// long as the others, and at the end of a round all threads would wait for it. So where there are few waves for each
// thread, chains are cut into small groups, and wave w gets groups w, w + waves, w + 2 waves, ...: all waves then have
// paths of all lengths. Where there are many waves, or one thread, nobody waits long, and a group is a whole wave.
class ChainLayout {
 public:
  // The chains of the settings' share, in waves of at most the settings' size.
  explicit ChainLayout(const RenderSettings& settings);

  size_t waves() const { return waves_; }
  size_t groups() const { return groups_; }
  // The most chains that a group has, and those of one group.
  size_t groupSize() const { return groupSize_; }
  size_t chainsOfGroup(size_t group) const;
  // The chains of a wave.
  size_t chainsOf(size_t wave) const;
  // The number, among the chains of all shares, of that in a lane of a wave.
  size_t chainAt(size_t wave, size_t lane) const {
    return part_ + parts_ * ((wave + lane / groupSize_ * waves_) * groupSize_ + lane % groupSize_);
  }

 private:
  size_t part_, parts_;
  size_t chains_, groupSize_, groups_, waves_;
};

// Which primary samples the chains of a method keep, for paths of up to maxDepth edges.
template <class S>
ChainState::Kept keptSamples(const Pipeline<S>& pipeline, const SceneView<S>& scene, uint32_t maxDepth);

// Of a bootstrap sample: its target.
constexpr size_t kBootstrapSampleBytes = sizeof(float);

// Waves that a worker holds where walks are joined: the walks', and those of WalkEnds.
constexpr size_t kWavesOfJoinedWalks = 4;

}  // namespace wavecrest
