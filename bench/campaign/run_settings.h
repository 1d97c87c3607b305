// What a campaign's settings say of its runs: which there are, how each renders, and when its snapshots are taken.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bench/campaign/campaign_settings.h"
#include "engine/scene/scene.h"
#include "engine/session/snapshots.h"

namespace wavecrest {

// The methods of a scene that this shard does. scene: its index. Groups of scene and method are counted through and
// dealt to the shards in turn.
std::vector<CampaignMethod> methodsOfShard(const CampaignSettings& settings, size_t scene);

// The settings of a run: the campaign's, with the method, the seed and the end of the run. Light paths apply to methods
// that merge only.
RenderSettings runSettings(const CampaignSettings& settings, const CampaignScene& entry, const Scene& scene,
                           const CampaignMethod& method, uint64_t seed);

// Snapshots of a run: after 1, 2, 4, ... iterations, or by time as the effort says.
SnapshotSchedule snapshotSchedule(const CampaignSettings& settings, const CampaignScene& entry);

}  // namespace wavecrest
