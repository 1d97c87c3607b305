// The stats object of a render: what --stats writes, and what image metadata repeats.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "engine/scene/scene.h"
#include "engine/session/session.h"
#include "metrics/image/image_io.h"
#include "wavecrest/results.h"

namespace wavecrest {

// Field names are fixed by the interface that scripts rely on; times in seconds, counts since the session began.
nlohmann::ordered_json renderStats(const Scene& scene, const RenderSettings& settings,
                                   const RenderStatistics& statistics, double loadSeconds, double wallSeconds,
                                   const std::vector<SnapshotRecord>& snapshots);

// The first radius of merges, relative to the scene's radius, in units of the scene, in pixels and by the photons that
// a search meets; the latter two where a typical camera path first merges.
nlohmann::ordered_json mergeRadiusJson(const MergeRadius& radius);

// What the program decided for itself where no option did, and why: objects of setting, value and why. Settings are
// method, guide, sampler, light_paths (of an iteration) and radius.
nlohmann::ordered_json decisionsJson(const Scene& scene, const RenderSettings& settings,
                                     const RenderStatistics& statistics);

// What the trials of evcm found, and the method that they led to.
nlohmann::ordered_json choiceJson(const MethodChoice& choice);

// What gpt was asked to learn, and has learned.
nlohmann::ordered_json guideJson(const RenderSettings& settings, const RenderStatistics& statistics);

// Every scalar of a stats object as a string attribute of an image (bench/image_attributes.h), and `guide.target`.
Metadata statsMetadata(const nlohmann::ordered_json& stats);

}  // namespace wavecrest
