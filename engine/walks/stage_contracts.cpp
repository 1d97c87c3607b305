#include "engine/walks/stage_contracts.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <tuple>

#include "kernels/columns/light_vertices.h"

namespace wavecrest {
namespace {

// How far the squared length of a unit vector may be from one.
constexpr double kUnitTolerance = 1e-4;

template <class S>
bool isUnit(S x, S y, S z) {
  const double length2 = static_cast<double>(x) * x + static_cast<double>(y) * y + static_cast<double>(z) * z;
  return std::abs(length2 - 1) < kUnitTolerance;
}

// Whether all columns of a queue that are not dropped have aligned memory, and the items fit there.
template <class Queue>
bool hasMemory(const Queue& queue) {
  // all() has one form, for writing.
  auto columns = const_cast<Queue&>(queue).all();
  const auto bound = [&](const auto& column) {
    const auto* const items = static_cast<const std::remove_reference_t<decltype(*column)>*>(column);
    const bool aligned = reinterpret_cast<uintptr_t>(items) % kColumnAlignment == 0;
    return !column.needed() || queue.capacity() == 0 || (items != nullptr && aligned);
  };
  const bool all = std::apply([&](const auto&... column) { return (bound(column) && ...); }, columns);
  return all && queue.size <= queue.capacity();
}

// Checks what holds before and after every stage. This function and those below return what should hold and does not,
// or nothing.
template <class S>
std::string_view brokenQueues(const StageContext<S>& context, const Wave<S>& wave) {
  if (context.scene == nullptr || context.counters == nullptr) return "a scene and counters";
  // Queues must fit their memory.
  if (!hasMemory(wave.rays) || !hasMemory(wave.paths)) return "rays and paths within their memory";
  if (!hasMemory(wave.hits) || !hasMemory(wave.surfaces)) return "hits and surfaces within their memory";
  if (!hasMemory(wave.shadowRays)) return "shadow rays within their memory";
  if (!hasMemory(wave.pairs) || !hasMemory(wave.sortedPairs)) return "pairs within their memory";
  if (!hasMemory(wave.vertexRows) || !hasMemory(wave.radiance)) return "rows and radiance within their memory";
  // Counts must agree with each other.
  if (wave.pathCount > wave.rays.capacity()) return "no more paths than lanes";
  if (wave.rays.size != wave.paths.size) return "a state for each ray";
  if (context.light.store != nullptr && !hasMemory(context.light.store->vertices))
    return "light vertices within their memory";
  return {};
}

// Checks the live paths and their rays after every stage.
template <class S>
std::string_view brokenPaths(const Wave<S>& wave) {
  for (size_t i = 0; i < wave.paths.size; ++i) {
    const auto& paths = wave.paths;
    const auto& rays = wave.rays;
    if (paths.lane[i] >= wave.rays.capacity()) return "lanes of the wave";
    if (!isUnit<S>(rays.directionX[i], rays.directionY[i], rays.directionZ[i])) return "unit directions";
    if (!std::isfinite(rays.originX[i] + rays.originY[i] + rays.originZ[i])) return "finite origins";
    for (const S value : {paths.throughputR[i], paths.throughputG[i], paths.throughputB[i]}) {
      if (std::isnan(value)) return "throughputs without NaN";
    }
    // NaN fails every comparison, hence the negated tests.
    if (!(paths.dVCM[i] >= 0)) return "MIS sums from 0";
    if (paths.dVC.needed() && !(paths.dVC[i] >= 0)) return "MIS sums from 0";
    if (paths.rouletteScale.needed() && !(paths.rouletteScale[i] > 0)) return "a scale for roulette";
  }
  return {};
}

// Checks the hits after extend.
template <class S>
std::string_view brokenHits(const SceneView<S>& scene, const Wave<S>& wave) {
  if (wave.hits.size != wave.rays.size) return "a hit for each ray";
  for (size_t i = 0; i < wave.hits.size; ++i) {
    const uint32_t primitive = wave.hits.primitive[i];
    if (primitive != kMiss && primitive >= scene.primitiveCount) return "primitives of the scene";
    if (primitive != kMiss && !std::isfinite(wave.hits.u[i] + wave.hits.v[i])) return "finite coordinates of hits";
    if (primitive == kMiss || scene.instances == nullptr || wave.hits.instance[i] == kNoIndex) continue;
    if (wave.hits.instance[i] >= scene.instanceCount) return "instances of the scene";
  }
  return {};
}

// After arrive: vertices in the order of their BSDFs.
template <class S>
std::string_view brokenVertices(const SceneView<S>& scene, const Wave<S>& wave) {
  const size_t count = wave.rays.size;
  if (wave.hits.size != count || wave.surfaces.size != count) return "a surface for each path";
  if (wave.joinable > count || wave.diffuse > wave.joinable) return "diffuse vertices among joinable ones among all";
  for (size_t i = 0; i < count; ++i) {
    const auto& surfaces = wave.surfaces;
    const uint32_t primitive = wave.hits.primitive[i];
    if (primitive >= scene.primitiveCount) return "vertices on primitives";
    if (!isUnit<S>(surfaces.normalX[i], surfaces.normalY[i], surfaces.normalZ[i])) return "unit normals";
    if (!(surfaces.offset[i] >= 0)) return "offsets from 0";
    const MaterialRecord& material = scene.materials[scene.primitives[primitive].material];
    if (i < wave.diffuse && static_cast<BsdfKind>(material.kind) != BsdfKind::diffuse) return "diffuse vertices first";
    if (i >= wave.joinable && (material.flags & kHasFinite) != 0) return "joinable vertices before others";
  }
  return {};
}

// Checks shadow rays after connections and next events. Targets are lanes of the wave, or pixels where light walks
// splat.
template <class S>
std::string_view brokenShadowRays(const StageContext<S>& context, const Wave<S>& wave) {
  const auto& shadow = wave.shadowRays;
  const size_t pixels = size_t{context.film.width} * context.film.height;
  const size_t targets = context.contributesToLanes() ? wave.rays.capacity() : pixels;
  for (size_t i = 0; i < shadow.size; ++i) {
    if (shadow.target[i] >= targets) return "targets of shadow rays on the film or in the wave";
    const float span = shadow.directionX[i] + shadow.directionY[i] + shadow.directionZ[i];
    if (std::isnan(span + shadow.originX[i] + shadow.originY[i] + shadow.originZ[i])) return "segments without NaN";
    for (const S value : {shadow.red[i], shadow.green[i], shadow.blue[i]}) {
      if (std::isnan(value)) return "contributions without NaN";
    }
  }
  return {};
}

// Links of light paths: to vertices that there are, each later than the one before.
template <class S>
std::string_view brokenLinks(const LightStore<S>& light) {
  if (!light.keepsLanes()) return {};
  const auto& vertices = light.vertices;
  for (size_t i = 0; i < vertices.size; ++i) {
    if (vertices.lane[i] >= light.lanes()) return "light vertices of the wave's paths";
    const uint32_t next = vertices.next[i];
    if (next != kNoIndex && ((next & kLinkIndex) >= vertices.size || (next & kLinkIndex) <= i)) return "links onwards";
  }
  for (size_t lane = 0; lane < light.lanes(); ++lane) {
    const uint32_t first = light.firstOfLane()[lane];
    if (first != kNoIndex && (first & kLinkIndex) >= vertices.size) return "first light vertices of paths";
  }
  return {};
}

// Reports a broken contract and ends the program. when: "before" or "after".
void refuse(std::string_view stage, const char* when, std::string_view what) {
  std::fprintf(stderr, "wavecrest: contract of stage '%.*s' broken %s it: expected %.*s\n",
               static_cast<int>(stage.size()), stage.data(), when, static_cast<int>(what.size()), what.data());
  std::abort();
}

}  // namespace

template <class S>
std::string_view brokenContract(std::string_view stage, const StageContext<S>& context, const Wave<S>& wave) {
  // Queues and paths are checked after every stage. The stage's name decides what else is checked.
  if (const auto broken = brokenQueues(context, wave); !broken.empty()) return broken;
  if (const auto broken = brokenPaths(wave); !broken.empty()) return broken;
  if (stage.starts_with("extend")) return brokenHits(*context.scene, wave);
  if (stage.starts_with("arrive")) return brokenVertices(*context.scene, wave);
  if (stage.starts_with("connect") || stage.starts_with("next event")) return brokenShadowRays(context, wave);
  if (stage.starts_with("store") && context.light.store != nullptr) return brokenLinks(*context.light.store);
  return {};
}

template <class S>
void requireBefore(std::string_view stage, const StageContext<S>& context, const Wave<S>& wave) {
  if (const auto broken = brokenQueues(context, wave); !broken.empty()) refuse(stage, "before", broken);
}
template <class S>
void requireAfter(std::string_view stage, const StageContext<S>& context, const Wave<S>& wave) {
  if (const auto broken = brokenContract(stage, context, wave); !broken.empty()) refuse(stage, "after", broken);
}

#define WAVECREST_INSTANTIATE_CONTRACTS(S)                                                            \
  template std::string_view brokenContract(std::string_view, const StageContext<S>&, const Wave<S>&); \
  template void requireBefore(std::string_view, const StageContext<S>&, const Wave<S>&);              \
  template void requireAfter(std::string_view, const StageContext<S>&, const Wave<S>&);
WAVECREST_INSTANTIATE_CONTRACTS(float)
WAVECREST_INSTANTIATE_CONTRACTS(double)
#undef WAVECREST_INSTANTIATE_CONTRACTS

}  // namespace wavecrest
