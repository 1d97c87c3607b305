#include "bench/campaign/merged_reference.h"

#include <algorithm>
#include <cassert>

#include "kernels/scene_view.h"

namespace wavecrest {

Reference mergedReference(const MergedParts& merged) {
  assert(!merged.halves[0].empty());
  const FilmArea& area = merged.film->area();
  const nlohmann::ordered_json &render = merged.header.render, &stats = merged.header.notes.at("stats");
  const auto word = [&](const char* key) { return render.at(key).get<std::string>(); };
  const auto depth = render.at("max_depth").get<uint32_t>();
  // A reference stores the method that rendered it, from which its bias follows.
  const std::string asked = word("method"), method = render.value("chosen", asked);
  const std::string choice = method == asked ? "" : ", chosen by the trials of " + asked;
  // Methods that do not merge have no radius.
  Reference reference{.mean = {.width = area.width, .height = area.height, .channels = 3, .pixels = merged.halves[0]},
                      .difference = {},
                      .info = {.scene = merged.header.scene,
                               .sceneHash = word("scene_hash"),
                               .method = method,
                               .sampler = word("sampler"),
                               .precision = word("precision"),
                               .seed = render.at("seed").get<uint64_t>(),
                               .maxDepth = std::min(depth, kMostEdges),  // as renderReference has it
                               .rouletteDepth = render.at("rr_depth").get<uint32_t>(),
                               .radius = render.value("radius", 0.0),
                               .radiusAlpha = render.value("radius_alpha", 0.0),
                               .methodReason = "parts of one render" + choice,
                               .iterations = stats.at("iterations").get<uint64_t>() / 2,
                               .renderSeconds = merged.work.renderSeconds,
                               .version = word("version"),
                               .commit = word("commit")},
                      .noiseFloors = {}};
  setHalves(reference, Image(reference.mean),
            {.width = area.width, .height = area.height, .channels = 3, .pixels = merged.halves[1]});
  measureNoiseFloors(reference);
  return reference;
}

}  // namespace wavecrest
