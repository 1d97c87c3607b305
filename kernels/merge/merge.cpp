// merge: density estimation with the iteration's photons at each camera vertex that has more than delta lobes.
//
// in: Rays (at vertices), Hits, Surfaces, PathStates [n]; the photon map. out: Radiance grows. METHODS 6.2, 6.4, 5.6
// (37)-(39). Candidates are (vertex, photon) pairs in a flat list, so that lanes are full whatever the photons per
// cell; pairs are summed in list order, which is the order of photons.
#include "kernels/merge/photon_map.h"
#include "kernels/mis_lanes.h"
#include "kernels/shade/shading_lanes.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

namespace {

constexpr uint32_t kRunShift = 30;  // the run (dy + 2 dz) of a candidate stands above its vertex index
constexpr uint32_t kIndexMask = (1u << kRunShift) - 1;

template <class Real>
WAVECREST_INLINE UInt cellOf(Real p, Real origin, Real inverseCell) {
  return toUInt(to<Float>(floor((p - origin) * inverseCell)));
}

template <class P, uint32_t kFeatures>
class Merger {
  using Real = typename P::Real;
  using S = typename P::Storage;

 public:
  Merger(const StageContext<S>& context, Wave<S>& wave)
      : context_(context), wave_(wave), map_(*context.photons), capacity_(wave.pairs.capacity()) {}

  // Lists the candidates of every vertex, and shades whenever the list is full.
  void run() {
    const auto& grid = map_.grid;
    const uint32_t* const start = map_.bucketStart.data();
    const UInt bucketMask(grid.bucketMask);
    for (size_t i = 0; i < wave_.rays.size; i += kLanes) {
      const Mask querying = queries(i);
      if (none(querying)) continue;
      const Real radius(context_.mis.radius), inverse(grid.inverseCell);
      const UInt x = cellOf(load(wave_.rays.originX, i) - radius, Real(grid.origin[0]), inverse);
      const UInt y = cellOf(load(wave_.rays.originY, i) - radius, Real(grid.origin[1]), inverse);
      const UInt z = cellOf(load(wave_.rays.originZ, i) - radius, Real(grid.origin[2]), inverse);
      // All look-ups before the first that is used: buckets are all over memory.
      UInt bucket[4]{x, x, x, x}, first[4]{x, x, x, x}, last[4]{x, x, x, x};
      for (uint32_t run = 0; run < 4; ++run) {
        bucket[run] = select(querying, (hash(y + UInt(run & 1), z + UInt(run >> 1)) + x) & bucketMask, UInt(0u));
        first[run] = gather(start, bucket[run]);
        last[run] = gather(start + 2, bucket[run]);
      }
      for (uint32_t run = 0; run < 4; ++run) {
        const UInt vertex = laneIndex(static_cast<uint32_t>(i)) | UInt(run << kRunShift);
        list(vertex, first[run], last[run], querying & (first[run] < last[run]));
        // After the last bucket comes the first.
        const Mask wraps = querying & (bucket[run] == bucketMask);
        if (any(wraps)) list(vertex, UInt(start[0]), UInt(start[1]), wraps);
      }
    }
    shade();
  }

 private:
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
    const Real reach = Real(context_.mis.radius);
    querying = querying & (load(wave_.rays.originX, i) - reach >= Real(grid.origin[0])) &
               (load(wave_.rays.originY, i) - reach >= Real(grid.origin[1])) &
               (load(wave_.rays.originZ, i) - reach >= Real(grid.origin[2]));
    if constexpr (has(kFeatures, kSpecularBsdfs)) {
      const auto& scene = *context_.scene;
      const UInt primitive = select(querying, load(wave_.hits.primitive, i), UInt(0u));
      const RecordLanes<PrimitiveRecord<S>> at(scene.primitives, primitive);
      const RecordLanes<MaterialRecord> material(scene.materials, at(scene.primitives->material));
      querying = querying & hasNonDeltaLobes(material(scene.materials->kind));
    }
    return querying;
  }

  // The candidates [first, last) of each lane in m.
  void list(UInt vertexAndRun, UInt first, UInt last, Mask m) {
    if (none(m)) return;
    HWY_ALIGN uint32_t vertices[kLanes], begin[kLanes], end[kLanes];
    store(compress(vertexAndRun, m), vertices);
    store(compress(first, m), begin);
    store(compress(last, m), end);
    for (size_t k = 0, count = countTrue(m); k < count; ++k) {
      for (uint32_t photon = begin[k]; photon < end[k]; ++photon) {
        if (count_ == capacity_) shade();
        __builtin_prefetch(map_.photons + photon);
        wave_.pairs.camera[count_] = vertices[k];
        wave_.pairs.light[count_] = photon;
        ++count_;
      }
    }
  }

  // Of the listed candidates keeps those within the radius, each found through its own cell, on the same side of the
  // surface and not beyond the path length; packs them to the front of the list.
  size_t selectNear() {
    const PhotonRecord<S>* const photons = map_.photons;
    const auto& grid = map_.grid;
    const auto& rays = wave_.rays;
    const auto& surfaces = wave_.surfaces;
    const Real radius(context_.mis.radius), inverse(grid.inverseCell);
    size_t out = 0;
    for (size_t i = 0; i < count_; i += kLanes) {
      const Mask active = firstLanes(count_ - i);
      const UInt camera = select(active, load(wave_.pairs.camera, i), UInt(0u));
      const UInt vertex = camera & UInt(kIndexMask), run = shiftRight<kRunShift>(camera);
      const UInt photon = select(active, load(wave_.pairs.light, i), UInt(0u));
      const RecordLanes<PhotonRecord<S>> at(photons, photon);
      const Vec3<Real> p = at(photons->position);
      const auto z = gatherVec3(rays.originX, rays.originY, rays.originZ, vertex);
      const Vec3<Real> between = p - z;
      Mask near = active & (length2(between) <= radius * radius);
      if (none(near)) continue;
      const UInt x0 = cellOf(z.x - radius, Real(grid.origin[0]), inverse);
      const UInt y0 = cellOf(z.y - radius, Real(grid.origin[1]), inverse) + (run & UInt(1u));
      const UInt z0 = cellOf(z.z - radius, Real(grid.origin[2]), inverse) + shiftRight<1>(run);
      const UInt px = cellOf(p.x, Real(grid.origin[0]), inverse);
      near = near & ((px == x0) | (px == x0 + UInt(1u))) & (cellOf(p.y, Real(grid.origin[1]), inverse) == y0) &
             (cellOf(p.z, Real(grid.origin[2]), inverse) == z0);
      const auto normal = gatherVec3(surfaces.normalX, surfaces.normalY, surfaces.normalZ, vertex);
      const Vec3<Real> photonNormal = at(photons->normal);
      near = near & (dot(normal, photonNormal) > Real(0.1f)) & (abs(dot(between, normal)) <= radius * Real(0.5f));
      // k = len_L + len_C
      near = near & (at(photons->depth) < UInt(context_.limits.maxDepth - context_.depth + 1));
      append(vertex, near, wave_.pairs.camera, out);
      append(photon, near, wave_.pairs.light, out);
      out += countTrue(near);
    }
    return out;
  }

  void shade() {
    const size_t accepted = selectNear();
    count_ = 0;
    context_.counters->merges += accepted;
    const auto& scene = *context_.scene;
    const PhotonRecord<S>* const photons = map_.photons;
    const auto& paths = wave_.paths;
    for (size_t i = 0; i < accepted; i += kLanes) {
      const Mask active = firstLanes(accepted - i);
      const UInt vertex = select(active, load(wave_.pairs.camera, i), UInt(0u));
      const UInt photon = select(active, load(wave_.pairs.light, i), UInt(0u));
      const auto shading = gatherShading<P, kFeatures>(scene, wave_, vertex);
      const RecordLanes<PhotonRecord<S>> at(photons, photon);
      const Vec3<Real> direction = at(photons->direction);
      const Vec3<Real> gen = shading.toLocal(direction);
      const auto bsdf = evalBsdf<P, kFeatures>(shading.bsdf, active, shading.fix, gen);
      Real weight(1);
      if (context_.mis.mergeWeights) {
        const MisSums<Real> light{at(photons->dVCM), Real(0), at(photons->dVM)};
        const MisSums<Real> camera{gather(paths.dVCM, vertex), Real(0), gather(paths.dVM, vertex)};
        // Where connections compete (kVC > 0) every edge may be one; else kVC is 0 and the switch does not matter.
        const Real wLight = behindMerge(context_.mis, 1, light, bsdf.pdf);
        const Real wCamera = behindMerge(context_.mis, 1, camera, bsdf.pdfReverse);
        weight = reciprocal<P>(Real(1) + wLight + wCamera);
      }
      const Real scale = Real(context_.mis.mergeNorm) * weight * abs(gen.z);
      const Vec3<Real> contribution = gatherVec3(paths.throughputR, paths.throughputG, paths.throughputB, vertex) *
                                      bsdf.f * at(photons->power) * scale;
      const Mask lit = active & shading.sidesAgree(direction, gen);
      addRadiance(wave_.radiance, gather(paths.lane, vertex), lit, contribution);
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
  Merger<P, kFeatures>(context, wave).run();
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_BIDIRECTIONAL_STAGE(merge)
