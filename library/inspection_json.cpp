#include "library/inspection_json.h"

#include <nlohmann/json.hpp>

#include "bench/campaign/render_stats.h"
#include "bench/enumerator_name.h"

namespace wavecrest {
namespace {

using nlohmann::ordered_json;

// The memory of a method, or why it cannot render the scene.
ordered_json toJson(const MethodInspection& row) {
  if (!row.refusal.empty()) return {{"refused", row.refusal}};
  ordered_json memory{{"bytes_per_path", row.memory.bytesPerPath}};
  memory.update(memoryJson(row.memory.use));
  return memory;
}

}  // namespace

ordered_json memoryJson(const MemoryUse& use) {
  return {{"scene_bytes", use.scene},
          {"wave_bytes", use.waves},
          {"film_bytes", use.film},
          {"splat_bytes", use.splats},
          {"light_vertex_bytes", use.lightVertices},
          {"photon_map_bytes", use.photonMap},
          {"guide_bytes", use.learned},
          {"chain_bytes", use.chains},
          {"image_bytes", use.image},
          {"total_bytes", use.total()}};
}

ordered_json inspectionJson(const Scene& scene, const SceneInspection& facts) {
  // Methods: kernels and memory of each.
  ordered_json specializations, memory, merging = ordered_json::object(), classes = ordered_json::array();
  for (const MethodInspection& row : facts.methods) {
    const std::string method(toString(row.method));
    specializations[method] = enumeratorName(kSpecializationNames, row.specialization);
    memory[method] = toJson(row);
    if (row.mergeRadius) merging[method] = mergeRadiusJson(*row.mergeRadius);
  }
  // Path classes: the verdict of each method.
  for (const PathClass& pathClass : facts.paths.classes) {
    ordered_json verdicts;
    for (const MethodEntry& entry : kMethods) {
      verdicts[std::string(entry.name)] = enumeratorName(kVerdictNames, facts.paths.verdict(pathClass, entry.method));
    }
    classes.push_back({{"class", pathClass.signature}, {"description", pathClass.description}, {"methods", verdicts}});
  }
  // What was approximated or left out when the scene was loaded.
  ordered_json notes = ordered_json::array();
  for (const Note& note : scene.notes) {
    notes.push_back({{"file", note.source.file},
                     {"line", note.source.line},
                     {"what", note.what},
                     {"effect", note.effect},
                     {"count", note.count}});
  }
  // All of it, in the order of the output. "specialization" is that of the first method; "specializations" has those of
  // all methods.
  const BoundingSphere& bounds = facts.bounds;
  // Vectors are arrays of three numbers.
  const auto vec = [](const double(&a)[3]) { return ordered_json{a[0], a[1], a[2]}; };
  return {{"scene", scene.name},
          {"features",
           {{"bsdfs", facts.bsdfs},
            {"lights", facts.lights},
            {"textures", facts.textures},
            {"sensor", facts.sensor},
            {"filter", facts.filter},
            {"needs", facts.needs}}},
          {"primitives",
           {{"quads", facts.primitives.quads},
            {"triangles", facts.primitives.triangles},
            {"spheres", facts.primitives.spheres},
            {"total", facts.primitives.total()},
            {"hierarchy_nodes", facts.hierarchyNodes},
            {"bytes_each", facts.bytesPerPrimitive},
            {"dropped_triangles", scene.droppedTriangles}}},
          {"instances", {{"groups", facts.groups}, {"instances", facts.instances}, {"copied", !facts.keepsInstances}}},
          {"bounds",
           {{"min", vec(bounds.low)},
            {"max", vec(bounds.high)},
            {"center", vec(bounds.center)},
            {"radius", bounds.radius}}},
          {"specialization", enumeratorName(kSpecializationNames, facts.methods.front().specialization)},
          {"specializations", specializations},
          {"accel", enumeratorName(kAccelNames, facts.accel)},
          {"memory", memory},
          {"merging", merging},
          {"path_classes", classes},
          {"reference_method", toString(facts.paths.reference.method)},
          {"reference_biased", facts.paths.reference.biased},
          {"reference_reason", facts.paths.reference.reason},
          {"notes", notes}};
}

}  // namespace wavecrest
