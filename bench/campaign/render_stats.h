// The stats object of a render: what --stats writes, and what image metadata repeats.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/results/results.h"
#include "engine/scene/scene.h"
#include "engine/session/session.h"
#include "metrics/image/image_io.h"

namespace wavecrest {

// Field names are fixed by the interface that scripts rely on; times in seconds, counts since the session began.
nlohmann::ordered_json renderStats(const Scene& scene, const RenderSettings& settings,
                                   const RenderStatistics& statistics, double loadSeconds, double wallSeconds,
                                   const std::vector<SnapshotRecord>& snapshots);

// Every scalar of a stats object as a string attribute of an image, its key after "wavecrest:".
Metadata statsMetadata(const nlohmann::ordered_json& stats);

}  // namespace wavecrest
