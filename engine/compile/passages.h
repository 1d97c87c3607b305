// Materials as kernels read them, with what they let straight on (METHODS 3.10).
#pragma once

#include <vector>

#include "engine/scene/scene.h"
#include "kernels/scene_view.h"

namespace wavecrest {

// Whether some light goes straight on through the material: a mask, a smooth boundary between equal indices, or a blend
// with such a part.
bool hasPassage(const Material& material, const Scene& scene);
// Whether that light may change its colour.
bool tintsPassage(const Material& material, const Scene& scene);

struct CompiledMaterials {
  std::vector<MaterialRecord> records;
  std::vector<CompoundRecord> compounds;  // of each record, if asked for
  std::vector<PassageRecord> passages;    // of each record; empty where no shape lets light through
  // Emitting surfaces need a vertex, so they have no passages: they let light through by a delta lobe. Index of the
  // first of the copies of all records, made without passages, for these surfaces. 0: there are no copies.
  uint32_t withoutPassages = 0;
};
CompiledMaterials compileMaterials(const Scene& scene, bool compounds);

}  // namespace wavecrest
