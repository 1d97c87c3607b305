// merge: density estimation with the iteration's photons at each camera vertex that has more than delta lobes.
//
// in: Rays (at vertices), Hits, Surfaces, PathStates [n]; the photon map. out: Radiance grows. METHODS 6.2, 6.4, 5.6
// (37)-(39). Candidates are (vertex, photon) pairs in a flat list, so that lanes are full whatever the photons per
// cell; a vertex sums its pairs in the order of photons. Most candidates only share a bucket with the vertex, so what
// is looked at first is their position alone; the rows of the others follow.
#include <algorithm>

#include "kernels/merge/photon_map.h"
#include "kernels/mis_lanes.h"
#include "kernels/shade/vertex_row_lanes.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

namespace {

constexpr uint32_t kRunShift = 30;  // the run (dy + 2 dz) of a candidate stands above its vertex index
constexpr uint32_t kIndexMask = (1u << kRunShift) - 1;
// Ends of a search are rounded; a photon that the distance test lets through must lie between them.
constexpr double kReach = 1 + 1e-5;

template <class P, uint32_t kFeatures>
class Merger {
  using Real = typename P::Real;
  using S = typename P::Storage;

 public:
  Merger(const StageContext<S>& context, Wave<S>& wave)
      : context_(context), wave_(wave), map_(*context.photons), capacity_(wave.pairs.capacity()) {}

  // Lists the candidates of every vertex, and shades whenever the list is full. Buckets and photons are all over
  // memory: some blocks are searched together, so that all of them have asked for what they will read before the first
  // reads.
  void run() {
    constexpr size_t kTogether = 4;
    Search searches[kTogether];
    for (size_t i = 0; i < wave_.rays.size; i += kTogether * kLanes) {
      const size_t blocks = std::min(kTogether, (wave_.rays.size - i + kLanes - 1) / kLanes);
      for (size_t k = 0; k < blocks; ++k) locate(i + k * kLanes, searches[k]);
      for (size_t k = 0; k < blocks; ++k) prefetch(map_.bucketStart, searches[k].bucket, searches[k]);
      for (size_t k = 0; k < blocks; ++k) lookUp(searches[k]);
      for (size_t k = 0; k < blocks; ++k) prefetch(map_.keys, searches[k].first, searches[k]);
      for (size_t k = 0; k < blocks; ++k) prefetch(map_.keys, searches[k].final, searches[k]);
      for (size_t k = 0; k < blocks; ++k) list(i + k * kLanes, searches[k]);
    }
    shade();
  }

 private:
  struct Cells {
    UInt x, y, z;
  };
  WAVECREST_INLINE Cells cellsOf(Vec3<Real> p) const {
    const auto& grid = map_.grid;
    const auto cell = [&](Real coordinate, S origin) WAVECREST_LAMBDA {
      return toUInt(to<Float>(floor((coordinate - Real(origin)) * Real(grid.inverseCell))));
    };
    return {cell(p.x, grid.origin[0]), cell(p.y, grid.origin[1]), cell(p.z, grid.origin[2])};
  }

  // The runs of photons that the vertices of a block look at, one for each row of cells: y and z of the lower cell, or
  // one more. In memory, where lanes are read one by one.
  static constexpr uint32_t kRuns = 4;
  using LaneNumbers = uint32_t[kLanes];
  struct Search {
    HWY_ALIGN LaneNumbers bucket[kRuns];
    HWY_ALIGN LaneNumbers first[kRuns], end[kRuns], final[kRuns];  // final: the last before the end, if there is one
    Mask searched[kRuns];
    Mask wide;  // two cells along x
  };
  template <class T>
  static WAVECREST_INLINE void prefetch(const T* base, const LaneNumbers (&index)[kRuns], const Search& search) {
    for (uint32_t run = 0; run < kRuns; ++run) {
      if (none(search.searched[run])) continue;
      for (const uint32_t lane : index[run]) __builtin_prefetch(base + lane);
    }
  }

  // Which buckets.
  WAVECREST_INLINE void locate(size_t i, Search& search) const {
    const Mask querying = queries(i);
    const Vec3<Real> position = loadVec3(wave_.rays.originX, wave_.rays.originY, wave_.rays.originZ, i);
    const Real reach(context_.mis.radius * kReach);
    const Cells low = cellsOf(position - Vec3<Real>{reach, reach, reach});
    const Cells high = cellsOf(position + Vec3<Real>{reach, reach, reach});
    const Mask twoAlongY = low.y != high.y, twoAlongZ = low.z != high.z;
    search.wide = querying & (low.x != high.x);
    search.searched[0] = querying;
    search.searched[1] = querying & twoAlongY;
    search.searched[2] = querying & twoAlongZ;
    search.searched[3] = querying & twoAlongY & twoAlongZ;
    const UInt bucketMask(map_.grid.bucketMask);
    for (uint32_t run = 0; run < kRuns; ++run) {
      if (none(search.searched[run])) continue;
      const UInt bucket = (hash(low.y + UInt(run & 1), low.z + UInt(run >> 1)) + low.x) & bucketMask;
      store(select(search.searched[run], bucket, UInt(0u)), search.bucket[run]);
    }
  }

  // Which photons.
  WAVECREST_INLINE void lookUp(Search& search) const {
    for (uint32_t run = 0; run < kRuns; ++run) {
      if (none(search.searched[run])) continue;
      const uint32_t* const bucket = search.bucket[run];
      const auto starts = loadFour([&](size_t k) WAVECREST_LAMBDA { return map_.bucketStart + bucket[k]; });
      const UInt first = starts.a, end = select(search.wide, starts.c, starts.b);
      store(first, search.first[run]);
      store(end, search.end[run]);
      store(select(first < end, end - UInt(1u), first), search.final[run]);
    }
  }

  WAVECREST_INLINE void list(size_t i, const Search& search) {
    const uint32_t* const start = map_.bucketStart;
    for (uint32_t run = 0; run < kRuns; ++run) {
      const Mask searched = search.searched[run];
      if (none(searched)) continue;
      const UInt vertex = laneIndex(static_cast<uint32_t>(i)) | UInt(run << kRunShift);
      list(vertex, load(search.first[run]), load(search.end[run]), searched);
      // After the last bucket comes the first.
      const Mask wraps = searched & search.wide & (load(search.bucket[run]) == UInt(map_.grid.bucketMask));
      if (any(wraps)) list(vertex, UInt(start[0]), UInt(start[1]), wraps);
    }
  }

  static WAVECREST_INLINE UInt hash(UInt y, UInt z) {
    UInt h = (y * UInt(0x9e3779b1u)) ^ (z * UInt(0x85ebca77u));
    h = h ^ shiftRight<15>(h);
    h = h * UInt(0x2c1b3c6du);
    return h ^ shiftRight<12>(h);
  }

  // Vertices of block i that can merge: inside the grid, with more than delta lobes.
  WAVECREST_INLINE Mask queries(size_t i) const {
    Mask querying = firstLanes(wave_.rays.size - i);
    const auto& grid = map_.grid;
    // Left of the grid's margin there is no photon within reach, and cell numbers would be negative.
    const Real reach(context_.mis.radius * kReach);
    querying = querying & (load(wave_.rays.originX, i) - reach >= Real(grid.origin[0])) &
               (load(wave_.rays.originY, i) - reach >= Real(grid.origin[1])) &
               (load(wave_.rays.originZ, i) - reach >= Real(grid.origin[2]));
    if constexpr (has(kFeatures, kSpecularBsdfs)) {
      const auto& scene = *context_.scene;
      const UInt primitive = select(querying, load(wave_.hits.primitive, i), UInt(0u));
      const RecordLanes<PrimitiveRecord<S>> at(scene.primitives, primitive);
      const MaterialLanes material(scene, at(scene.primitives->material));
      querying = querying & hasNonDeltaLobes(material(scene.materials->kind));
    }
    return querying;
  }

  // The candidates [first, last) of each lane in m: the first of every lane, then the second, and so on.
  WAVECREST_INLINE void list(UInt vertexAndRun, UInt first, UInt last, Mask m) {
    for (Mask more = m & (first < last); any(more); more = m & (first < last)) {
      if (count_ + kLanes > capacity_) shade();
      append(vertexAndRun, more, wave_.pairs.camera, count_);
      append(first, more, wave_.pairs.light, count_);
      count_ += countTrue(more);
      first = first + UInt(1u);
    }
  }

  // Whole blocks of the list are read: those that its end leaves open get pairs of the first vertex and photon.
  WAVECREST_INLINE void closeList(size_t end) const {
    storeUnaligned(UInt(0u), wave_.pairs.camera + end);
    storeUnaligned(UInt(0u), wave_.pairs.light + end);
  }

  // Of the listed candidates keeps those within the radius, each found through its own cell; packs vertex and photon to
  // the front of the list, and asks for the photons' rows.
  size_t selectNear() {
    const Real radius(context_.mis.radius);
    const Real reach(context_.mis.radius * kReach);
    closeList(count_);
    size_t out = 0, asked = 0;
    // Of pairs that were packed some time ago, as what is read one by one waits for what is written as a vector.
    const auto ask = [&](size_t end) WAVECREST_LAMBDA {
      for (; asked < end; ++asked) {
        const uint32_t photon = map_.keys[wave_.pairs.light[asked]].photon;
        wave_.pairs.light[asked] = photon;
        __builtin_prefetch(&map_.rowOf(photon));
      }
    };
    for (size_t i = 0; i < count_; i += kLanes) {
      const Mask active = firstLanes(count_ - i);
      const uint32_t* const cameras = wave_.pairs.camera + i;
      const uint32_t* const keys = wave_.pairs.light + i;
      const auto photonAt = [&](size_t k) WAVECREST_LAMBDA { return map_.keys[keys[k]].position; };
      const auto vertexAt = [&](size_t k)
                                WAVECREST_LAMBDA { return wave_.vertexRows.row[cameras[k] & kIndexMask].position; };
      const FourColumns<Real> ofPhoton = loadFour(photonAt), ofVertex = loadFour(vertexAt);
      const Vec3<Real> p{ofPhoton.a, ofPhoton.b, ofPhoton.c}, z{ofVertex.a, ofVertex.b, ofVertex.c};
      const UInt camera = load(wave_.pairs.camera, i), key = load(wave_.pairs.light, i);
      const UInt vertex = camera & UInt(kIndexMask), run = shiftRight<kRunShift>(camera);
      const size_t packed = out;
      Mask near = active & (length2(p - z) <= radius * radius);
      if (none(near)) continue;
      const Cells low = cellsOf(z - Vec3<Real>{reach, reach, reach}), own = cellsOf(p);
      near = near & ((own.x == low.x) | (own.x == low.x + UInt(1u))) & (own.y == low.y + (run & UInt(1u))) &
             (own.z == low.z + shiftRight<1>(run));
      append(vertex, near, wave_.pairs.camera, out);
      append(key, near, wave_.pairs.light, out);
      out += countTrue(near);
      ask(packed);
    }
    ask(out);
    closeList(out);
    return out;
  }

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

  void shade() {
    const size_t near = selectNear();
    count_ = 0;
    const auto& scene = *context_.scene;
    const auto& paths = wave_.paths;
    const Real radius(context_.mis.radius);
    // k = len_L + len_C
    const Real longest(static_cast<float>(context_.limits.maxDepth - context_.depth));
    const auto vec3 = [](const FourColumns<Real>& row) WAVECREST_LAMBDA { return Vec3<Real>{row.a, row.b, row.c}; };
    for (size_t i = 0; i < near; i += kLanes) {
      const Mask active = firstLanes(near - i);
      const PhotonLanes photons(map_, wave_.pairs.light + i, near - i);
      const UInt vertex = load(wave_.pairs.camera, i);
      const auto row = gatherRows<P, kFeatures>(scene, wave_.vertexRows.row, wave_.surfaces, wave_.pairs.camera + i);
      const auto& shading = row.shading;
      const Vec3<Real> between = vec3(photons(&VertexRow<S>::position)) - shading.position;
      const FourColumns<Real> back = photons(&VertexRow<S>::fix), facing = photons(&VertexRow<S>::normal),
                              carried = photons(&VertexRow<S>::throughput);
      const Vec3<Real> direction = vec3(back), normal = vec3(facing);
      // On the same side of the surface, and not beyond the path length.
      const Mask accepted = active & (dot(shading.normal, normal) > Real(0.1f)) &
                            (abs(dot(between, shading.normal)) <= radius * Real(0.5f)) &
                            (edgesOfTag(back.d) <= longest);
      context_.counters->merges += countTrue(accepted);
      const auto bsdf = shading.scattering(active, direction);
      // METHODS 3.9; directions within the surface carry nothing that a merge could use.
      const Real cosine = abs(dot(direction, normal));
      const Real perCosine = zeroUnless(cosine > Real(1e-6f), reciprocal<P>(max(cosine, Real(1e-6f))));
      Real weight(1);
      if (context_.mis.mergeWeights) {
        const MisSums<Real> light{facing.d, Real(0), mergeSum(context_.mis, carried.d)};
        const MisSums<Real> camera{row.dVCM, Real(0), mergeSum(context_.mis, row.behind)};
        // Where connections compete (kVC > 0) every edge may be one; else kVC is 0 and the switch does not matter.
        const Real wLight = behindMerge(context_.mis, 1, light, bsdf.pdf);
        const Real wCamera = behindMerge(context_.mis, 1, camera, bsdf.pdfReverse);
        weight = reciprocal<P>(Real(1) + wLight + wCamera);
      }
      const Real scale = Real(context_.mis.mergeNorm) * weight * bsdf.lightCosine;
      const Vec3<Real> contribution = row.throughput * bsdf.f * (vec3(carried) * perCosine) * scale;
      addRadiance(wave_.radiance, gather(paths.lane, vertex), accepted, contribution);
    }
  }

  const StageContext<S>& context_;
  Wave<S>& wave_;
  const PhotonMap<S>& map_;
  const size_t capacity_;
  size_t count_ = 0;
};

}  // namespace

template <class P, uint32_t kFeatures>
void merge(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  if (context.depth + 1 > context.limits.maxDepth || context.photons->size == 0) return;
  packVertexRows<kFeatures>(context, wave);
  Merger<P, kFeatures>(context, wave).run();
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_BIDIRECTIONAL_STAGE(merge)
