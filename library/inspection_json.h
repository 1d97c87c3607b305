// What a scene is made of and what methods can do in it, as JSON: what `wavecrest inspect --json` prints.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "engine/inspect/inspection.h"
#include "engine/scene/scene.h"

namespace wavecrest {

// Bytes by what they are for, and their sum.
nlohmann::ordered_json memoryJson(const MemoryUse& use);
nlohmann::ordered_json inspectionJson(const Scene& scene, const SceneInspection& facts);

}  // namespace wavecrest
