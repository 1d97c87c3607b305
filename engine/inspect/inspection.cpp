#include "engine/inspect/inspection.h"

#include <utility>

#include "engine/compile/materials.h"
#include "engine/compile/overloaded.h"
#include "engine/pilot/finished_plan.h"
#include "engine/plan/memory_plan.h"
#include "engine/scene/scene_error.h"

namespace wavecrest {
namespace {

// The plugin of a material's innermost BSDF.
std::string nameOf(const Material& material) {
  return std::visit(
      Overloaded{[](const Diffuse&) -> std::string { return "diffuse"; },
                 [](const Conductor& c) -> std::string { return isSmooth(c) ? "conductor" : "roughconductor"; },
                 [](const Dielectric& d) -> std::string {
                   return d.thin ? "thindielectric" : isSmooth(d) ? "dielectric" : "roughdielectric";
                 },
                 [](const Plastic& p) -> std::string { return isSmooth(p) ? "plastic" : "roughplastic"; },
                 [](const Phong&) -> std::string { return "phong"; },
                 [](const Principled& p) -> std::string { return p.thin ? "principledthin" : "principled"; },
                 [](const Blend&) -> std::string { return "blendbsdf"; }},
      material.kind);
}

std::string nameOf(const Emitter& emitter) {
  return std::visit(Overloaded{[](const AreaEmitter&) -> std::string { return "area"; },
                               [](const PointEmitter&) -> std::string { return "point"; },
                               [](const SpotEmitter&) -> std::string { return "spot"; },
                               [](const SunskyEmitter&) -> std::string { return "sunsky"; },
                               [](const ProjectorEmitter&) -> std::string { return "projector"; },
                               [](const DirectionalEmitter&) -> std::string { return "directional"; },
                               [](const ConstantEmitter&) -> std::string { return "constant"; },
                               [](const EnvmapEmitter&) -> std::string { return "envmap"; }},
                    emitter.kind);
}

// What the scene asks of its kernels, in words. keeps: its instances.
std::vector<std::string> needsOf(const Scene& scene, bool keeps) {
  constexpr std::pair<uint32_t, const char*> kWords[] = {
      {kSpecularBsdfs, "specular BSDFs"},
      {kLayeredBsdfs, "layered BSDFs"},
      {kTextures, "textures"},
      {kShadingNormals, "shading normals"},
      {kNormalMaps, "bump or normal maps"},
      {kCurvedShapes, "analytic spheres"},
      {kRareLights, "spot, projector, directional or environment lights"},
      {kCompoundBsdfs, "compound BSDFs"},
      {kInstances, "instances"}};
  const uint32_t features = sceneFeatures(scene, keeps);
  std::vector<std::string> needs;
  for (const auto& [bit, words] : kWords) {
    if ((features & bit) != 0) needs.emplace_back(words);
  }
  if (scene.sensor.kind != Sensor::Kind::perspective || scene.film.filter != ReconstructionFilter::box) {
    needs.emplace_back("a lens or filter beyond pinhole and box");
  }
  return needs;
}

// Counts BSDFs and their wrappers, lights and textures, each by its plugin.
void countKinds(const Scene& scene, SceneInspection& out) {
  for (const Material& material : scene.materials) {
    ++out.bsdfs[nameOf(material)];
    if (material.twoSided) ++out.bsdfs["twosided"];
    if (material.opacity) ++out.bsdfs["mask"];
    if (material.bumpTexture != kNone) ++out.bsdfs["bumpmap"];
    if (material.normalTexture != kNone) ++out.bsdfs["normalmap"];
  }
  for (const Emitter& emitter : scene.emitters) ++out.lights[nameOf(emitter)];
  for (const Texture& texture : scene.textures) {
    ++out.textures[std::holds_alternative<BitmapTexture>(texture.kind) ? "bitmap" : "checkerboard"];
  }
}

// What the scene is compiled to, for kernels of S.
template <class S>
void inspectCompiled(const Scene& scene, const RenderSettings& settings, SceneInspection& out) {
  const auto compiled = compileScene<S>(scene, settings.accel, true, settings.instancing);
  out.groups = scene.groups.size();
  out.instances = scene.instances.size();
  out.keepsInstances = compiled->view.instances != nullptr;
  out.needs = needsOf(scene, out.keepsInstances);
  out.primitives = compiled->primitives.counts;
  out.bounds = compiled->bounds;
  // The compiled scene is relative to its origin, the bounds here are not.
  for (size_t axis = 0; axis < 3; ++axis) {
    for (double* coordinate : {&out.bounds.center[axis], &out.bounds.low[axis], &out.bounds.high[axis]}) {
      *coordinate += compiled->origin[axis];
    }
  }
  out.accel = compiled->accel();
  out.hierarchyNodes = compiled->bvh ? compiled->bvh->nodes() : 0;
  out.bytesPerPrimitive = static_cast<double>(primitiveBytes(*compiled)) / out.primitives.total();
}

}  // namespace

SceneInspection inspectScene(const Scene& scene, RenderSettings settings) {
  // What the file says.
  SceneInspection out;
  countKinds(scene, out);
  out.sensor = Sensor::kKindNames[static_cast<size_t>(scene.sensor.kind)];
  out.filter = kFilterNames[static_cast<size_t>(scene.film.filter)];
  // What it is compiled to.
  if (settings.precision == Precision::doubled) {
    inspectCompiled<double>(scene, settings, out);
  } else {
    inspectCompiled<float>(scene, settings, out);
  }
  // What each method does with it, or why it refuses.
  for (const MethodEntry& entry : kMethods) {
    MethodInspection& row = out.methods.emplace_back();
    row.method = settings.method = entry.method;
    if (!settings.samplerIsChosen) settings.sampler = bestSampler(settings);
    row.specialization = specializationFor(scene, settings);
    try {
      const DryPlan facts = planWithoutSession(scene, settings);
      row.memory = facts.memory;
      row.mergeRadius = facts.mergeRadius;
    } catch (const SceneError& error) {
      row.refusal = error.what();
    }
  }
  // Which paths the scene has.
  out.paths = classifyPaths(findLinks(scene), settings.limits.maxDepth);
  return out;
}

}  // namespace wavecrest
