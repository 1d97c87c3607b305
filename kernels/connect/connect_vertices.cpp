// connectVertices: strategies s >= 2, t >= 2. Joins camera vertices with the vertices of their paired light paths, and
// pushes shadow rays with the weighted contributions.
//
// in: Rays (at vertices), Hits, Surfaces, PathStates [n]; the light store of the wave's light paths. out: ShadowRays
// [<= capacity], in the order in which pairs are joined. METHODS 5.6.
//
// Light paths have few vertices or none, so the pairs are listed first: 16 lanes then work on 16 pairs, wherever on
// their paths the vertices are. The list begins with the first vertex of each path and goes on from pairs to those with
// the vertices after. Pairs that there is no room for wait for the next repetition of the stage, while Wave::openPairs
// is not 0. Those of two diffuse vertices, most in most scenes, are joined first, by a kernel that knows no other BSDF.
#include <algorithm>
#include <utility>

#include "kernels/columns/light_vertices.h"
#include "kernels/connect/roulette_lanes.h"
#include "kernels/extend/offset_lanes.h"
#include "kernels/mis_lanes.h"
#include "kernels/shade/bsdf_ranges.h"
#include "kernels/shade/vertex_row_lanes.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

namespace {

// The index in a link, which is no vertex's where the link leads nowhere.
WAVECREST_INLINE UInt indexOf(UInt link) { return link & UInt(kLinkIndex); }

WAVECREST_INLINE size_t appendPairs(UInt camera, UInt light, Mask m, VertexPairs& pairs, size_t count) {
  append(camera, m, pairs.camera, count);
  append(light, m, pairs.light, count);
  return count + countTrue(m);
}

// Lists pairs of camera vertices and light vertices of one lane.
template <class S>
class PairLister {
 public:
  PairLister(const StageContext<S>& context, Wave<S>& wave)
      : wave_(wave), firstOfLane_(context.light.store->firstOfLane()), next_(context.light.store->vertices.next) {
    // k = len_L + 1 + len_C
    const uint32_t longest = context.limits.maxDepth - context.depth - 1;
    begin_ = static_cast<uint32_t>(context.light.store->firstOf(context.light.depths.first));
    end_ = static_cast<uint32_t>(context.light.store->firstOf(std::min(longest, context.light.depths.last) + 1));
  }

  // The next pairs, from the front of the list; how many.
  WAVECREST_INLINE size_t list(bool fromTheFirst) {
    const size_t before = wave_.pairs.size;
    size_t open = 0, count = fromTheFirst ? listFirst() : listNext(before - wave_.openPairs, before, 0);
    while (open != count && 2 * count - open <= wave_.pairs.capacity()) {
      const size_t end = listNext(open, count, count);
      open = std::exchange(count, end);
    }
    wave_.pairs.size = count;
    wave_.openPairs = count - open;
    // Whole blocks are read: those that the list's end leaves open get pairs of the first vertices.
    appendPairs(UInt(0u), UInt(0u), allLanes(), wave_.pairs, count);
    return count;
  }

 private:
  // Each camera vertex with the first vertex of its light path.
  WAVECREST_INLINE size_t listFirst() {
    size_t count = 0;
    for (size_t i = 0; i < wave_.joinable; i += kLanes) {
      const Mask active = firstLanes(wave_.joinable - i);
      UInt light = gather(firstOfLane_, select(active, load(wave_.paths.lane, i), UInt(0u)));
      for (;;) {
        const Mask before = active & (indexOf(light) < UInt(begin_));
        if (none(before)) break;
        light = select(before, gather(next_, select(before, indexOf(light), UInt(0u))), light);
      }
      const Mask found = active & (indexOf(light) < UInt(end_));
      count = appendPairs(laneIndex(static_cast<uint32_t>(i)), light, found, wave_.pairs, count);
    }
    return count;
  }
  // The camera vertices of the pairs [i, end) with the vertices after those that they are paired with.
  WAVECREST_INLINE size_t listNext(size_t i, size_t end, size_t count) {
    for (; i < end; i += kLanes) {
      const Mask active = firstLanes(end - i);
      const UInt last = indexOf(loadUnaligned(wave_.pairs.light + i));
      const UInt light = gather(next_, select(active, last, UInt(0u)));
      const Mask found = active & (indexOf(light) < UInt(end_));
      count = appendPairs(loadUnaligned(wave_.pairs.camera + i), light, found, wave_.pairs, count);
    }
    return count;
  }

  Wave<S>& wave_;
  const uint32_t *firstOfLane_, *next_;
  uint32_t begin_, end_;  // light vertices that are joined
};

// Light vertices of all depths are joined together: where there are connections, edgeSwitch() is 1 at each of them.
constexpr uint32_t kAnyLightDepth = 2;

// How many pairs ahead rows of light vertices are prefetched: the caches do not hold those of a whole iteration.
constexpr size_t kRowsAhead = 128;

// A number for each pair.
template <class S>
WAVECREST_INLINE Float rouletteNumbers(const StageContext<S>& context, const Wave<S>& wave, UInt lane, UInt light) {
  UInt depth(1u);
  for (uint32_t d = 2; d <= context.light.store->depths(); ++d) {
    const Mask shallower = light < UInt(static_cast<uint32_t>(context.light.store->firstOf(d)));
    depth = depth + select(shallower, UInt(0u), UInt(1u));
  }
  return rouletteNumber(draw(context, pathOf(context, wave, lane), Block::opacity).d, depth);
}

// Weighted contributions of a block of pairs of vertices that have BSDFs of kBsdfs; shadow rays from `out` on; where
// they end.
template <class P, uint32_t kBsdfs>
WAVECREST_NOINLINE size_t joinBlock(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave,
                                    const VertexPairs& pairs, size_t i, Mask active, size_t out) {
  using Real = typename P::Real;
  const auto& scene = *context.scene;
  const auto& vertices = context.light.store->vertices;
  auto& shadow = wave.shadowRays;

  HWY_ALIGN uint32_t lanes[kLanes];
  readEach(
      pairs.camera + i, kLanes, [&](uint32_t v) WAVECREST_LAMBDA { return wave.paths.lane[v]; }, lanes);
  const auto zRow = gatherRows<P, kBsdfs>(scene, wave.vertexRows.row, wave.surfaces, pairs.camera + i);
  auto yRow = gatherRows<P, kBsdfs>(scene, vertices.row, vertices, pairs.light + i);
  yRow.shading.bsdf.walk = Walk::light;
  const auto &z = zRow.shading, &y = yRow.shading;

  const Vec3<Real> segment = y.position - z.position;
  const Real dist2 = length2(segment);
  const Real inverseDistance = reciprocalSqrt(max(dist2, Real(1e-37f)));
  const Vec3<Real> towards = segment * inverseDistance;  // from the camera vertex to the light vertex
  const auto zBsdf = z.scattering(active, towards);
  const auto yBsdf = y.scattering(active, -towards);

  const Real inverseDist2 = inverseDistance * inverseDistance;
  const Real zCosine = abs(dot(towards, z.normal)), yCosine = abs(dot(towards, y.normal));
  const Real wLight = zBsdf.pdf * yCosine * inverseDist2 *
                      behindConnection(context.mis, Walk::light, kAnyLightDepth, yRow.mis, yBsdf.pdfReverse);
  const Real wCamera = yBsdf.pdf * zCosine * inverseDist2 *
                       behindConnection(context.mis, Walk::camera, context.depth, zRow.mis, zBsdf.pdfReverse);

  // c_z(omega_l) at the camera's end; c_y(omega_l) / n_y(omega_l) n_y(to z) at the light's (METHODS 3.9).
  const Real yWi = max(abs(y.wiCosine), Real(kSmallestCosine));
  const Real scale =
      zBsdf.lightCosine * yBsdf.lightCosine * yCosine * inverseDist2 * reciprocal(yWi * (Real(1) + wLight + wCamera));
  Vec3<Real> contribution = zRow.throughput * zBsdf.f * yRow.throughput * yBsdf.f * scale;

  // Points closer than the offsets that keep their segment off the surfaces cannot be told apart.
  const Real apart = Real(4) * (z.offset + y.offset);
  const Real carried = maxComponent(abs(contribution));
  const Mask carries = active & (carried > Real(0)), tooClose = carries & (dist2 <= apart * apart);
  if (any(tooClose)) context.counters->closePairs += countTrue(tooClose);
  Mask lit = andNot(carries, tooClose);
  if (context.light.rouletteBelow > 0) {
    const Real chance = rouletteChance(carried, Real(context.light.rouletteBelow));
    if (any(lit & (chance < Real(1)))) {
      const UInt light = load(pairs.light, i);
      lit = lit & (to<Real>(rouletteNumbers(context, wave, load(lanes), light)) < chance);
      contribution = contribution * (Real(1) / chance);
    }
  }
  if (none(lit)) return out;
  const Vec3<Real> origin = offsetOrigin(z.position, z.normal, z.offset, towards);
  const Vec3<Real> end = offsetOrigin(y.position, y.normal, endOffset(y.offset, dist2 * inverseDistance), -towards);
  appendShadowRays(shadow, lit, origin, end, contribution, load(lanes), out);
  if (scene.passages != nullptr) append(wLight + wCamera, lit, shadow.others, out);
  return out + countTrue(lit);
}

// Copies the listed pairs to Wave::sortedPairs, with indices for links: first those of two diffuse vertices, whose
// number it returns, then the others.
template <class S>
size_t sortPairs(Wave<S>& wave, size_t count) {
  auto& sorted = wave.sortedPairs;
  size_t diffuse = 0, out = 0;
  for (const bool first : {true, false}) {
    for (size_t i = 0; i < count; i += kLanes) {
      const UInt camera = load(wave.pairs.camera, i), light = load(wave.pairs.light, i);
      const Mask alike = (camera < UInt(static_cast<uint32_t>(wave.diffuse))) & (light < UInt(kOtherLink));
      const Mask active = firstLanes(count - i);
      out = appendPairs(camera, indexOf(light), first ? active & alike : andNot(active, alike), sorted, out);
    }
    if (first) diffuse = out;
  }
  appendPairs(UInt(0u), UInt(0u), allLanes(), sorted, out);
  return diffuse;
}

// Weighted contributions of the listed pairs, as shadow rays; how many.
template <class P, uint32_t kFeatures>
size_t joinPairs(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave, size_t count) {
  const auto& rows = context.light.store->vertices.row;
  size_t diffuse = count;
  if constexpr (!onlyDiffuse(kFeatures)) diffuse = sortPairs(wave, count);
  const VertexPairs& pairs = onlyDiffuse(kFeatures) ? wave.pairs : wave.sortedPairs;
  size_t out = 0;
  size_t asked = 0;
  for (size_t i = 0; i < count; i += kLanes) {
    for (const size_t end = std::min(i + kRowsAhead, count); asked < end; ++asked) {
      __builtin_prefetch(rows + pairs.light[asked]);
    }
    out = withBsdfs<kFeatures>(i + kLanes <= diffuse, [&](auto bsdfs) WAVECREST_LAMBDA {
      return joinBlock<P, decltype(bsdfs)::value>(context, wave, pairs, i, firstLanes(count - i), out);
    });
  }
  return out;
}

}  // namespace

template <class P, uint32_t kFeatures>
void connectVertices(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  auto& shadow = wave.shadowRays;
  shadow.size = 0;
  if (context.light.repetition == 0) wave.openPairs = 0;
  if (context.depth + 2 > context.limits.maxDepth) return;  // one edge, and one to each vertex's origin at least
  packVertexRows<kFeatures>(context, wave);

  const size_t pairs = PairLister(context, wave).list(context.light.repetition == 0);
  context.counters->connections += pairs;
  shadow.claim(pairs);
  shadow.size = joinPairs<P, kFeatures>(context, wave, pairs);
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_BIDIRECTIONAL_STAGE(connectVertices)
