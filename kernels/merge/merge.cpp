// merge: density estimation with the iteration's photons at each camera vertex that has more than delta lobes.
//
// in: Rays (at vertices), Hits, Surfaces, PathStates [n]; the photon map. out: Radiance grows. METHODS 6.2, 6.4, 5.6
// (37)-(39). Candidates are (vertex, photon) pairs in a flat list, so that lanes are full whatever the photons per
// cell; a vertex sums its pairs in the order in which they are listed. Most candidates are hash
// collisions. Quantised positions reject them; exact rows decide about the rest.
#include <algorithm>

#include "kernels/bsdf/passage_lanes.h"
#include "kernels/merge/photon_grid_lanes.h"
#include "kernels/merge/photon_map.h"
#include "kernels/mis_lanes.h"
#include "kernels/shade/bsdf_ranges.h"
#include "kernels/shade/vertex_row_lanes.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

namespace {

// A vertex of the wave, as runs and candidates name it: its index, above that whether it looks at two cells along x,
// the run (dy + 2 dz), and in the highest bits those of the strip, as in a photon's place.
constexpr uint32_t kRunShift = kPlaceStripShift - 2, kWideBit = kRunShift - 1;
constexpr uint32_t kIndexMask = (1u << kWideBit) - 1;
// Ends of a search are rounded; a photon that the distance test lets through must lie between them.
constexpr double kReach = 1 + 1e-5;

template <class P, uint32_t kFeatures>
class Merger {
  using Real = typename P::Real;
  using S = typename P::Storage;

 public:
  Merger(const StageContext<S>& context, Wave<S>& wave)
      : context_(context), wave_(wave), map_(*context.light.photons), inGrid_(map_.grid) {}

  // Buckets, photons and rows are all over memory: each is prefetched some blocks of vertices before it is read, and
  // rows are read once the next ones have been prefetched.
  void run() {
    const size_t blocks = (wave_.joinable + kLanes - 1) / kLanes, groups = (blocks + kTogether - 1) / kTogether;
    Search searches[3][kTogether];
    // Of groups before the first, whose numbers wrap, and after the last there are none.
    const auto forGroup = [&](size_t group, const auto& function) WAVECREST_LAMBDA {
      if (group >= groups) return;
      const size_t first = group * kTogether, count = std::min(kTogether, blocks - first);
      for (size_t k = 0; k < count; ++k) function(searches[group % 3][k], (first + k) * kLanes);
    };
    for (size_t group = 0; group < groups + 2; ++group) {
      forGroup(group, [&](Search& search, size_t i) WAVECREST_LAMBDA {
        locate(i, search);
        prefetchBuckets(search);
      });
      forGroup(group - 1, [&](Search& search, size_t) WAVECREST_LAMBDA {
        findRuns(search);
        prefetchKeys(search);
      });
      settled_ = prefetched_;
      forGroup(group - 2, [&](Search& search, size_t) WAVECREST_LAMBDA {
        listCandidates(search);
        if (nearCount_ - prefetched_ >= kLanes) prefetchRows();
      });
      prefetchRows();
      if (settled_ >= kNear / 2) shade(wholeBlocks(settled_));
    }
    shade(nearCount_);
  }

 private:
  static constexpr size_t kTogether = 2;  // blocks

  // The runs of photons that the vertices of a block search, one for each strip of cells: y and z of the lower cell,
  // or one more. In memory, where lanes are read one by one, and looked up.
  static constexpr uint32_t kRuns = 4;
  template <size_t kSize>
  using Numbers = uint32_t[kSize];
  struct Search {
    size_t count;  // of runs
    HWY_ALIGN Numbers<(kRuns + 1) * kLanes> vertex, bucket, first, end;
    // Of the block's vertices, in quanta from the lower cell on, as bits of floats; and the place of that cell, which
    // turns parities into numbers of cells.
    HWY_ALIGN Numbers<kLanes> x, y, z, lower;
  };

  WAVECREST_INLINE CellLanes lowerCells(Vec3<Real> position) const {
    const Real reach(context_.mis.radius * kReach);
    return cellsOf(inGrid_(position - Vec3<Real>{reach, reach, reach}));
  }

  // Which buckets.
  WAVECREST_INLINE void locate(size_t i, Search& search) const {
    const Mask querying = queries(i);
    const Vec3<Real> position = loadVec3(wave_.rays.originX, wave_.rays.originY, wave_.rays.originZ, i);
    const Real reach(context_.mis.radius * kReach);
    const CellLanes low = lowerCells(position), high = cellsOf(inGrid_(position + Vec3<Real>{reach, reach, reach}));
    const Mask twoAlongY = low.y != high.y, twoAlongZ = low.z != high.z;
    const UInt wide = select(low.x != high.x, UInt(1u << kWideBit), UInt(0u));
    const Mask searched[kRuns] = {querying, querying & twoAlongY, querying & twoAlongZ,
                                  querying & twoAlongY & twoAlongZ};
    search.count = 0;
    for (uint32_t run = 0; run < kRuns; ++run) {
      const UInt strip = stripOf(low.y + UInt(run & 1), low.z + UInt(run >> 1));
      const UInt vertex =
          laneIndex(static_cast<uint32_t>(i) | run << kRunShift) | wide | (strip & UInt(kPlaceStripMask));
      storeUnaligned(compress(vertex, searched[run]), search.vertex + search.count);
      storeUnaligned(compress((strip + low.x) & UInt(map_.bucketMask), searched[run]), search.bucket + search.count);
      search.count += countTrue(searched[run]);
    }
    storeUnaligned(UInt(0u), search.bucket + search.count);  // whole blocks are read
    const Vec3<Real> inCells = inGrid_(position);
    const auto quanta = [](Real inGrid, UInt cell) WAVECREST_LAMBDA {
      return bits(to<Float>((inGrid - to<Real>(toFloat(cell))) * Real(static_cast<float>(kQuantaPerCell))));
    };
    store(quanta(inCells.x, low.x), search.x);
    store(quanta(inCells.y, low.y), search.y);
    store(quanta(inCells.z, low.z), search.z);
    store(packAxes(parityBit(low.x), parityBit(low.y), parityBit(low.z)), search.lower);
  }

  WAVECREST_INLINE void prefetchBuckets(const Search& search) const {
    for (size_t k = 0; k < search.count; ++k) __builtin_prefetch(map_.bucketStart + search.bucket[k]);
  }

  // Which photons.
  WAVECREST_INLINE void findRuns(Search& search) const {
    for (size_t i = 0; i < search.count; i += kLanes) {
      const uint32_t* const bucket = search.bucket + i;
      const auto starts = loadFour([&](size_t k) WAVECREST_LAMBDA { return map_.bucketStart + bucket[k]; });
      store(starts.a, search.first + i);
      store(select(hasBit(load(search.vertex + i), kWideBit), starts.c, starts.b), search.end + i);
    }
  }

  WAVECREST_INLINE void prefetchKeys(const Search& search) const {
    for (size_t k = 0; k < search.count; ++k) {
      __builtin_prefetch(map_.keys + search.first[k]);
      __builtin_prefetch(map_.keys + std::max(search.end[k], 1u) - 1);
    }
  }

  // Vertices of block i that can merge: inside the grid.
  WAVECREST_INLINE Mask queries(size_t i) const {
    Mask querying = firstLanes(wave_.joinable - i);
    const auto& grid = map_.grid;
    // Left of the grid's margin there is no photon within reach, and cell numbers would be negative.
    const Real reach(context_.mis.radius * kReach);
    querying = querying & (load(wave_.rays.originX, i) - reach >= Real(grid.origin[0])) &
               (load(wave_.rays.originY, i) - reach >= Real(grid.origin[1])) &
               (load(wave_.rays.originZ, i) - reach >= Real(grid.origin[2]));
    if (context_.mis.firstMerges) querying = querying & isFirstMerge(loadMis<kFeatures>(wave_.paths, i));
    return querying;
  }

  // ---- candidates ---------------------------------------------------------------------------------------------------

  // Lists the candidates of a block, and those of them that are near.
  WAVECREST_INLINE void listCandidates(const Search& search) {
    const uint32_t* const start = map_.bucketStart;
    size_t count = 0;
    for (size_t i = 0; i < search.count; i += kLanes) {
      const Mask searched = firstLanes(search.count - i);
      const UInt vertex = load(search.vertex + i);
      count = list(search, vertex, load(search.first + i), load(search.end + i), searched, count);
      // After the last bucket comes the first.
      const Mask wraps = searched & hasBit(vertex, kWideBit) & (load(search.bucket + i) == UInt(map_.bucketMask));
      if (any(wraps)) count = list(search, vertex, UInt(start[0]), UInt(start[1]), wraps, count);
    }
    selectNear(search, count);
  }

  // The candidates [first, last) of each lane in m: the first of every lane, then the second, and so on. How many there
  // are then, if there were `count`.
  WAVECREST_INLINE size_t list(const Search& search, UInt vertex, UInt first, UInt last, Mask m, size_t count) {
    for (Mask more = m & (first < last); any(more); more = m & (first < last)) {
      if (count > kCandidates) {
        selectNear(search, count);
        count = 0;
      }
      storeUnaligned(compress(vertex, more), candidateVertex_ + count);
      storeUnaligned(compress(first, more), candidateKey_ + count);
      count += countTrue(more);
      first = first + UInt(1u);
    }
    return count;
  }

  // Of the listed candidates of a block those that may be within the radius.
  void selectNear(const Search& search, size_t count) {
    const double quanta = context_.mis.radius * kReach * static_cast<double>(map_.grid.inverseCell) * kQuantaPerCell;
    const double reach = quanta + static_cast<double>(map_.grid.slack);
    const Float reach2(reach * reach);
    // Whole blocks are read: those that the list's end leaves open get the first photon.
    storeUnaligned(UInt(0u), candidateKey_ + count);
    readEach(
        candidateKey_, count, [this](uint32_t key) WAVECREST_LAMBDA { return map_.keys[key].place; }, candidatePlace_);
    for (size_t i = 0; i < count; i += kLanes) {
      const UInt vertex = load(candidateVertex_ + i), key = load(candidateKey_ + i);
      const UInt lane = vertex & UInt(kLanes - 1);
      const UInt place = load(candidatePlace_ + i);
      // From the lower cell on: the parity says which of the two.
      const UInt fromLower = place ^ lookUp(search.lower, lane);
      const auto away = [&](const Numbers<kLanes>& coordinate, UInt quantum) WAVECREST_LAMBDA {
        return fromBits(lookUp(coordinate, lane)) - (toFloat(quantum & UInt(kQuantaMask)) + Float(0.5f));
      };
      const Float dx = away(search.x, fromLower), dy = away(search.y, shiftRight<kQuantaBits>(fromLower)),
                  dz = away(search.z, shiftRight<2 * kQuantaBits>(fromLower));
      const Mask near = firstLanes(count - i) & (mulAdd(dx, dx, mulAdd(dy, dy, dz * dz)) <= reach2) &
                        (((vertex ^ place) & UInt(kPlaceStripMask)) == UInt(0u));
      if (nearCount_ > kNear) {
        prefetchRows();
        shade(wholeBlocks(kNear / 2));  // the rest have just been prefetched
      }
      storeUnaligned(compress(vertex & UInt(kIndexMask), near), nearVertex_ + nearCount_);
      storeUnaligned(compress(shiftRight<kRunShift>(vertex) & UInt(kRuns - 1), near), nearRun_ + nearCount_);
      storeUnaligned(compress(key, near), nearPhoton_ + nearCount_);
      nearCount_ += countTrue(near);
    }
  }

  // Of the photons that have been listed since it was called last.
  WAVECREST_INLINE void prefetchRows() {
    for (; prefetched_ < nearCount_; ++prefetched_) {
      const uint32_t photon = map_.keys[nearPhoton_[prefetched_]].photon;
      nearPhoton_[prefetched_] = photon;
      __builtin_prefetch(&map_.rowOf(photon));
    }
  }

  // ---- rows ---------------------------------------------------------------------------------------------------------

  // The photons of a block of the list, scattered over the stores. Lanes past the last repeat it.
  class PhotonLanes {
   public:
    WAVECREST_INLINE PhotonLanes(const PhotonMap<S>& map, const uint32_t* photons, size_t count) {
      for (size_t k = 0; k < kLanes; ++k) row_[k] = &map.rowOf(photons[std::min(k, count - 1)]);
    }
    // A field and the number after it.
    WAVECREST_INLINE FourColumns<Real> operator()(S (VertexRow<S>::*field)[3]) const {
      return loadFour([&](size_t k) WAVECREST_LAMBDA { return row_[k]->*field; });
    }

   private:
    const VertexRow<S>* row_[kLanes];
  };

  // Which photons p a vertex z finds in a run: those within the radius, in the run's strip and the vertex's two cells.
  WAVECREST_INLINE Mask found(Vec3<Real> p, Vec3<Real> z, UInt run) const {
    const Real radius(context_.mis.radius);
    const CellLanes low = lowerCells(z), own = cellsOf(inGrid_(p));
    return (length2(p - z) <= radius * radius) & ((own.x == low.x) | (own.x == low.x + UInt(1u))) &
           (own.y == low.y + (run & UInt(1u))) & (own.z == low.z + shiftRight<1>(run));
  }

  static constexpr size_t wholeBlocks(size_t count) { return count / kLanes * kLanes; }

  // Merges the first photons of the list, and removes them.
  void shade(size_t count) {
    // Whole blocks are read: those that the end leaves open get the next ones, or the first vertex.
    storeUnaligned(UInt(0u), nearVertex_ + nearCount_);
    for (size_t i = 0; i < count; i += kLanes) {
      const bool diffuse = allDiffuse(wave_, load(nearVertex_ + i));
      withBsdfs<kFeatures>(diffuse, [&](auto bsdfs) WAVECREST_LAMBDA { shadeBlock<decltype(bsdfs)::value>(i, count); });
    }
    for (uint32_t* const list : {nearVertex_, nearRun_, nearPhoton_}) std::copy(list + count, list + nearCount_, list);
    nearCount_ -= count;
    prefetched_ -= count;
    settled_ -= std::min(settled_, count);
  }

  // Block i of the first `count`, found by vertices whose BSDFs are of kBsdfs.
  template <uint32_t kBsdfs>
  WAVECREST_NOINLINE void shadeBlock(size_t i, size_t count) {
    const Real radius(context_.mis.radius);
    // k = len_L + len_C
    const Real longest(static_cast<float>(context_.limits.maxDepth - context_.depth));
    const auto vec3 = [](const FourColumns<Real>& row) WAVECREST_LAMBDA { return Vec3<Real>{row.a, row.b, row.c}; };
    const Mask active = firstLanes(count - i);
    const PhotonLanes photons(map_, nearPhoton_ + i, count - i);
    HWY_ALIGN uint32_t lanes[kLanes];
    readEach(
        nearVertex_ + i, kLanes, [this](uint32_t v) WAVECREST_LAMBDA { return wave_.paths.lane[v]; }, lanes);
    const auto row = gatherRows<P, kBsdfs>(*context_.scene, wave_.vertexRows.row, wave_.surfaces, nearVertex_ + i);
    const auto& shading = row.shading;
    const Vec3<Real> position = vec3(photons(&VertexRow<S>::position));
    const FourColumns<Real> back = photons(&VertexRow<S>::wi), facing = photons(&VertexRow<S>::normal),
                            carried = photons(&VertexRow<S>::throughput);
    const Vec3<Real> direction = vec3(back), normal = vec3(facing);
    // On the same side of the surface, and not beyond the path length.
    const Mask accepted = active & found(position, shading.position, load(nearRun_ + i)) &
                          (dot(shading.normal, normal) > Real(0.1f)) &
                          (abs(dot(position - shading.position, shading.normal)) <= radius * Real(0.5f)) &
                          (edgesOfTag(back.d) <= longest);
    context_.counters->merges += countTrue(accepted);
    const auto bsdf = shading.scattering(active, direction);
    // METHODS 3.9; directions within the surface carry nothing that a merge could use.
    const Real cosine = abs(dot(direction, normal));
    const Real perCosine = zeroUnless(cosine > Real(0), reciprocal(max(cosine, Real(kSmallestCosine))));
    Real weight(1);
    if (context_.mis.mergeWeights) {
      const MisSums<Real> light{facing.d, carried.d};
      const Real wLight = behindMerge(context_.mis, light, bsdf.pdf);
      const Real wCamera = behindMerge(context_.mis, row.mis, bsdf.pdfReverse);
      weight = reciprocal(Real(1) + wLight + wCamera);
    }
    const Real scale = Real(context_.mis.mergeNorm) * weight * bsdf.lightCosine * inverseOfStop<kBsdfs>(active, i);
    const Vec3<Real> contribution = row.throughput * bsdf.f * (vec3(carried) * perCosine) * scale;
    // Where f and the densities are 0 an infinite sum makes the weight NaN.
    const Mask carries = accepted & (maxComponent(abs(contribution)) > Real(0));
    addRadiance(wave_.radiance, load(lanes), carries, contribution);
  }

  // Both walks have stopped at a surface that lets light through, each with its probability, where the light that the
  // surface scatters has it once (METHODS 3.10).
  template <uint32_t kBsdfs>
  WAVECREST_INLINE Real inverseOfStop(Mask active, size_t i) const {
    const auto& scene = *context_.scene;
    if (scene.passages == nullptr) return Real(1);
    const UInt vertex = select(active, load(nearVertex_ + i), UInt(0u));
    const UInt material = materialOf(scene, gather(wave_.hits.primitive, vertex));
    Float u(0), v(0);
    if constexpr (has(kBsdfs, kTextures)) {
      u = gather(wave_.surfaces.uvU, vertex);
      v = gather(wave_.surfaces.uvV, vertex);
    }
    return Real(1) / max(passageOf<P>(scene, material, active, u, v).stop, Real(1e-6f));
  }

  // Lists have room for a whole vector beyond the count at which they are emptied, and for one more of zeros.
  static constexpr size_t kCandidates = 512, kNear = 256, kRoom = 2 * kLanes;

  const StageContext<S>& context_;
  Wave<S>& wave_;
  const PhotonMap<S>& map_;
  const GridLanes<Real> inGrid_;
  // Of one block: the vertex and run that each was found by, and its key.
  HWY_ALIGN uint32_t candidateVertex_[kCandidates + kRoom];
  HWY_ALIGN uint32_t candidateKey_[kCandidates + kRoom];
  HWY_ALIGN uint32_t candidatePlace_[kCandidates + kRoom];
  // Of all blocks: index of the vertex, run, and photon, where it has been prefetched, else its key.
  HWY_ALIGN uint32_t nearVertex_[kNear + kRoom];
  HWY_ALIGN uint32_t nearRun_[kNear + kRoom];
  HWY_ALIGN uint32_t nearPhoton_[kNear + kRoom];
  size_t nearCount_ = 0, prefetched_ = 0, settled_ = 0;  // settled: prefetched before the searches that go on
};

}  // namespace

template <class P, uint32_t kFeatures>
void merge(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  if (context.depth + 1 > context.limits.maxDepth || context.light.photons->size == 0) return;
  packVertexRows<kFeatures>(context, wave);
  Merger<P, kFeatures>(context, wave).run();
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_BIDIRECTIONAL_STAGE(merge)
