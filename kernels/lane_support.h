// What stage kernels share: precision policies in lanes, loads of column triples, gathers of scene records, and the
// instantiation of a stage for every precision and feature set.
#pragma once

#include "kernels/sampling/random_lanes.h"
#include "kernels/simd/interleave.h"
#include "kernels/simd/vec3.h"
#include "kernels/stages.h"

WAVECREST_SIMD_BEGIN

struct FloatPrecision {
  using Real = Float;
  using Storage = float;
  static constexpr Precision kPrecision = Precision::floating;
};
struct DoublePrecision {
  using Real = Double;
  using Storage = double;
  static constexpr Precision kPrecision = Precision::doubled;
};

template <class Real>
WAVECREST_INLINE Real reciprocal(Real a) {
  return Real(1) / a;
}
// 1 / sqrt(a)
template <class Real>
WAVECREST_INLINE Real reciprocalSqrt(Real a) {
  return Real(1) / sqrt(a);
}
// Of linear sRGB.
template <class Real>
WAVECREST_INLINE Real luminanceOf(Vec3<Real> c) {
  return mulAdd(c.x, Real(0.2126f), mulAdd(c.y, Real(0.7152f), c.z * Real(0.0722f)));
}

// ---- columns --------------------------------------------------------------------------------------------------------

template <class T>
WAVECREST_INLINE auto load(const Column<T>& column, size_t i) {
  return load(static_cast<const T*>(column) + i);
}
template <class V, class T>
WAVECREST_INLINE void store(V a, const Column<T>& column, size_t i) {
  store(a, static_cast<T*>(column) + i);
}
// Appends the lanes of a where m holds at index `out` of the column.
template <class V, class T>
WAVECREST_INLINE void append(V a, Mask m, const Column<T>& column, size_t out) {
  storeUnaligned(compress(a, m), static_cast<T*>(column) + out);
}

template <class S>
WAVECREST_INLINE auto loadVec3(const Column<S>& x, const Column<S>& y, const Column<S>& z, size_t i) {
  return Vec3<decltype(load(x, i))>{load(x, i), load(y, i), load(z, i)};
}
template <class T>
WAVECREST_INLINE auto gather(const Column<T>& column, UInt index) {
  return gather(static_cast<const T*>(column), index);
}
// out[i] = read(index[i]) for i < count. Reads the indices as scalars: faster than a gather of 16 lanes. `volatile`
// keeps g++ from loading a vector of indices and extracting its lanes.
template <class T, class Read>
WAVECREST_INLINE void readEach(const uint32_t* index, size_t count, const Read& read, T* out) {
  const volatile uint32_t* const listed = index;
  for (size_t i = 0; i < count; ++i) out[i] = read(listed[i]);
}

template <class S>
WAVECREST_INLINE auto gatherVec3(const Column<S>& x, const Column<S>& y, const Column<S>& z, UInt index) {
  return Vec3<decltype(gather(x, index))>{gather(x, index), gather(y, index), gather(z, index)};
}
template <class Real, class S>
WAVECREST_INLINE void storeVec3(Vec3<Real> a, const Column<S>& x, const Column<S>& y, const Column<S>& z, size_t i) {
  store(a.x, x, i);
  store(a.y, y, i);
  store(a.z, z, i);
}
template <class Real, class S>
WAVECREST_INLINE void appendVec3(Vec3<Real> a, Mask m, const Column<S>& x, const Column<S>& y, const Column<S>& z,
                                 size_t out) {
  append(a.x, m, x, out);
  append(a.y, m, y, out);
  append(a.z, m, z, out);
}

// Appends shadow rays from origin to end where m holds, but not ShadowRays::others.
template <class Real, class S>
WAVECREST_INLINE void appendShadowRays(const ShadowRays<S>& shadow, Mask m, Vec3<Real> origin, Vec3<Real> end,
                                       Vec3<Real> contribution, UInt target, size_t out) {
  appendVec3(to<Float>(origin), m, shadow.originX, shadow.originY, shadow.originZ, out);
  appendVec3(to<Float>(end - origin), m, shadow.directionX, shadow.directionY, shadow.directionZ, out);
  appendVec3(contribution, m, shadow.red, shadow.green, shadow.blue, out);
  append(target, m, shadow.target, out);
}

// Stores the lanes of a where m holds, each at its index; no index comes twice.
template <class V, class T>
WAVECREST_INLINE void storeWhere(V a, Mask m, T* target, UInt index) {
  HWY_ALIGN T values[kLanes];
  HWY_ALIGN uint32_t indices[kLanes];
  store(compress(a, m), values);
  store(compress(index, m), indices);
  for (size_t k = 0, count = countTrue(m); k < count; ++k) target[indices[k]] = values[k];
}
template <class V, class T>
WAVECREST_INLINE void storeWhere(V a, Mask m, const Column<T>& column, UInt index) {
  storeWhere(a, m, static_cast<T*>(column), index);
}
template <class Real, class S>
WAVECREST_INLINE void storeWhere(Vec3<Real> a, Mask m, const Column<S>& x, const Column<S>& y, const Column<S>& z,
                                 UInt index) {
  storeWhere(a.x, m, x, index);
  storeWhere(a.y, m, y, index);
  storeWhere(a.z, m, z, index);
}

// Adds a to the radiance of the given lanes, one after the other: a lane may come more than once.
template <class Real, class S>
WAVECREST_INLINE void addRadiance(Radiance<S>& radiance, UInt lane, Mask m, Vec3<Real> a) {
  HWY_ALIGN S values[3][kLanes];
  HWY_ALIGN uint32_t lanes[kLanes];
  store(compress(a.x, m), values[0]);
  store(compress(a.y, m), values[1]);
  store(compress(a.z, m), values[2]);
  store(compress(lane, m), lanes);
  for (size_t i = 0, count = countTrue(m); i < count; ++i) {
    radiance.red[lanes[i]] += values[0][i];
    radiance.green[lanes[i]] += values[1][i];
    radiance.blue[lanes[i]] += values[2][i];
  }
}

// Appends the lanes of a where m holds to the queue of splats, in lane order.
template <class S, class Real>
WAVECREST_INLINE void pushSplats(Splats<S>& splats, UInt pixel, Mask m, Vec3<Real> a) {
  const size_t out = splats.claim(countTrue(m));
  appendVec3(a, m, splats.red, splats.green, splats.blue, out);
  append(pixel, m, splats.pixel, out);
}

// ---- scene records --------------------------------------------------------------------------------------------------

// One record per lane: `RecordLanes prims(base, index); prims(base->p0)` gathers that field of each lane's record.
template <class Record>
class RecordLanes {
 public:
  WAVECREST_INLINE RecordLanes(const Record*, UInt index)
      : wordIndex_(index * UInt(sizeof(Record) / sizeof(uint32_t))),
        longIndex_(index * UInt(sizeof(Record) / sizeof(double))) {}
  WAVECREST_INLINE Float operator()(const float& field) const { return gather(&field, wordIndex_); }
  WAVECREST_INLINE UInt operator()(const uint32_t& field) const { return gather(&field, wordIndex_); }
  WAVECREST_INLINE Double operator()(const double& field) const { return gather(&field, longIndex_); }
  // Each lane's own element of an array in its record.
  template <size_t kSize>
  WAVECREST_INLINE Float operator()(const float (&field)[kSize], UInt element) const {
    return gather(field, wordIndex_ + element);
  }
  WAVECREST_INLINE Vec3<Double> operator()(const double (&field)[3]) const {
    return {(*this)(field[0]), (*this)(field[1]), (*this)(field[2])};
  }
  // Reads one word more: of a record's last field that is padding, which alignment gives it.
  WAVECREST_INLINE Vec3<Float> operator()(const float (&field)[3]) const {
    const FourColumns<Float> row = four(field[0]);
    return {row.a, row.b, row.c};
  }
  // A field and the three numbers after it.
  WAVECREST_INLINE FourColumns<Float> four(const float& first) const { return gatherFour(&first, wordIndex_); }
  WAVECREST_INLINE FourColumns<Double> four(const double& first) const { return gatherFour(&first, longIndex_); }

 private:
  UInt wordIndex_, longIndex_;
};

// The same where there may be few records: those are looked up in registers, which costs a fraction of a gather. index:
// of a record for every lane.
template <class Record, class Table>
class TableLanes {
 public:
  WAVECREST_INLINE TableLanes(const Record* records, const Table* table, uint32_t count, UInt index)
      : records_(records), table_(count <= Table::kRegisters * kLanes ? table : nullptr), index_(index) {}
  WAVECREST_INLINE UInt operator()(const uint32_t& field) const {
    return table_ != nullptr ? word(reinterpret_cast<const std::byte*>(&field)) : gathered()(field);
  }
  WAVECREST_INLINE Float operator()(const float& field) const {
    return table_ != nullptr ? fromBits(word(reinterpret_cast<const std::byte*>(&field))) : gathered()(field);
  }
  WAVECREST_INLINE FourColumns<Float> four(const float& first) const {
    if (table_ == nullptr) return gathered().four(first);
    const float* const field = &first;
    return {(*this)(field[0]), (*this)(field[1]), (*this)(field[2]), (*this)(field[3])};
  }
  WAVECREST_INLINE Vec3<Float> operator()(const float (&field)[3]) const {
    if (table_ == nullptr) return gathered()(field);
    return {(*this)(field[0]), (*this)(field[1]), (*this)(field[2])};
  }
  // Each lane's own element of an array that is not in the table.
  template <size_t kSize>
  WAVECREST_INLINE Float operator()(const float (&field)[kSize], UInt element) const {
    return gathered()(field, element);
  }

 private:
  // Made when it is asked for: what is kept is copied wherever records are passed on.
  WAVECREST_INLINE RecordLanes<Record> gathered() const { return {records_, index_}; }
  WAVECREST_INLINE UInt word(const std::byte* field) const {
    const auto offset = static_cast<size_t>(field - reinterpret_cast<const std::byte*>(records_));
    const uint32_t* const words = table_->words[offset / sizeof(uint32_t)];
    if constexpr (Table::kRegisters == 1) {
      return lookUp(words, index_);
    } else {
      static_assert(Table::kRegisters == 2);
      const UInt within = index_ & UInt(static_cast<uint32_t>(kLanes - 1));
      return select(index_ == within, lookUp(words, within), lookUp(words + kLanes, within));
    }
  }

  const Record* records_;
  const Table* table_;
  UInt index_;
};

// `MaterialLanes material(scene, index); material(scene.materials->kind)`
struct MaterialLanes : TableLanes<MaterialRecord, MaterialTable> {
  template <class S>
  WAVECREST_INLINE MaterialLanes(const SceneView<S>& scene, UInt index)
      : TableLanes(scene.materials, scene.materialTable, scene.materialCount, index) {}
};

// `const auto at = primitivesOf(scene, index); at(scene.primitives->kind)`
WAVECREST_INLINE TableLanes<PrimitiveRecord<float>, PrimitiveTable> primitivesOf(const SceneView<float>& scene,
                                                                                 UInt index) {
  return {scene.primitives, scene.primitiveTable, scene.primitiveCount, index};
}
WAVECREST_INLINE RecordLanes<PrimitiveRecord<double>> primitivesOf(const SceneView<double>& scene, UInt index) {
  return {scene.primitives, index};
}
template <class S>
using PrimitiveLanes = decltype(primitivesOf(std::declval<const SceneView<S>&>(), UInt()));

// The same face for a record that all lanes share: `OneRecord()(base->p0)` broadcasts that field.
struct OneRecord {
  WAVECREST_INLINE Float operator()(const float& field) const { return Float(field); }
  WAVECREST_INLINE UInt operator()(const uint32_t& field) const { return UInt(field); }
  WAVECREST_INLINE Double operator()(const double& field) const { return Double(field); }
  template <class S>
  WAVECREST_INLINE auto operator()(const S (&field)[3]) const {
    return Vec3<decltype((*this)(field[0]))>{(*this)(field[0]), (*this)(field[1]), (*this)(field[2])};
  }
};

template <class Real>
WAVECREST_INLINE Vec3<Real> broadcast(const double (&a)[3]) {
  return {Real(a[0]), Real(a[1]), Real(a[2])};
}

WAVECREST_INLINE constexpr bool has(uint32_t features, uint32_t feature) { return (features & feature) != 0; }

// Raster position of each lane's path, and its path word: the index in the full film, and the iteration.
struct PixelLanes {
  UInt x, y, path;
};
template <class S>
WAVECREST_INLINE PixelLanes pixelsOf(const StageContext<S>& context, const Wave<S>& wave, UInt lane) {
  const UInt packed = gather(context.pixels + wave.firstPath, shiftRight(lane, wave.iterationBits));
  const UInt ahead = lane & UInt((1u << wave.iterationBits) - 1);
  const UInt x = packed & UInt(0xffffu);
  const UInt y = shiftRight<16>(packed);
  return {x, y, y * UInt(context.scene->camera.width) + x + shiftLeft<kPathBits>(ahead)};
}

// The path word that random numbers depend on (kernels/sampling/sampler.h): the path is the raster index for camera
// paths; light paths, and the paths of chains, are counted.
template <class S>
WAVECREST_INLINE UInt pathOf(const StageContext<S>& context, const Wave<S>& wave, UInt lane) {
  if (context.walk == Walk::light || context.pixels == nullptr)
    return lane + UInt(static_cast<uint32_t>(wave.firstPath));
  return pixelsOf(context, wave, lane).path;
}

// Keeps quotients by a cosine finite. Directions this close to the surface occur with a probability of about its
// square.
constexpr double kSmallestCosine = 1e-12;

// Whether a feature set's paths carry PathStates::rouletteScale.
constexpr bool hasRouletteScale(uint32_t features) { return has(features, kSpecularBsdfs | kBidirectional); }

// Four numbers of the vertex at the context's depth.
template <class S>
WAVECREST_INLINE Uniform4 draw(const StageContext<S>& context, UInt path, Block block) {
  return uniform4(context.sampler, path, 4 * context.depth + static_cast<uint32_t>(block),
                  context.walk == Walk::camera ? Stream::camera : Stream::light);
}

WAVECREST_SIMD_END

// Compiles STAGE<Precision, features> for every precision and specialisation of isCompiled() (kernels/stages.h).
#ifdef WAVECREST_ONLY_COMPLETE_KERNELS
#define WAVECREST_INSTANTIATE_PLAIN(STAGE)
#define WAVECREST_INSTANTIATE_BIDIRECTIONAL(STAGE)
#else
#define WAVECREST_INSTANTIATE_PLAIN(STAGE)              \
  WAVECREST_INSTANTIATE(STAGE, FloatPrecision, diffuse) \
  WAVECREST_INSTANTIATE(STAGE, FloatPrecision, smooth)  \
  WAVECREST_INSTANTIATE(STAGE, FloatPrecision, plain)
#define WAVECREST_INSTANTIATE_BIDIRECTIONAL(STAGE)                   \
  WAVECREST_INSTANTIATE(STAGE, FloatPrecision, diffuseBidirectional) \
  WAVECREST_INSTANTIATE(STAGE, FloatPrecision, smoothBidirectional)  \
  WAVECREST_INSTANTIATE(STAGE, FloatPrecision, plainBidirectional)
#endif
#define WAVECREST_INSTANTIATE_ALL_FEATURES(STAGE)        \
  WAVECREST_INSTANTIATE(STAGE, FloatPrecision, complete) \
  WAVECREST_INSTANTIATE(STAGE, DoublePrecision, complete)
#define WAVECREST_INSTANTIATE_STAGE(STAGE)   \
  WAVECREST_SIMD_BEGIN                       \
  WAVECREST_INSTANTIATE_PLAIN(STAGE)         \
  WAVECREST_INSTANTIATE_BIDIRECTIONAL(STAGE) \
  WAVECREST_INSTANTIATE_ALL_FEATURES(STAGE)  \
  WAVECREST_SIMD_END
// The same for a stage that only bidirectional methods have.
#define WAVECREST_INSTANTIATE_BIDIRECTIONAL_STAGE(STAGE) \
  WAVECREST_SIMD_BEGIN                                   \
  WAVECREST_INSTANTIATE_BIDIRECTIONAL(STAGE)             \
  WAVECREST_INSTANTIATE_ALL_FEATURES(STAGE)              \
  WAVECREST_SIMD_END
// And for a stage that no feature changes: one for each precision, whatever the set.
#define WAVECREST_INSTANTIATE_COMMON_STAGE(STAGE)             \
  WAVECREST_SIMD_BEGIN                                        \
  WAVECREST_INSTANTIATE_FOR_PRECISION(STAGE, FloatPrecision)  \
  WAVECREST_INSTANTIATE_FOR_PRECISION(STAGE, DoublePrecision) \
  WAVECREST_SIMD_END
#define WAVECREST_INSTANTIATE_FOR_PRECISION(STAGE, PRECISION) \
  template void STAGE<PRECISION>(const StageContext<PRECISION::Storage>&, Wave<PRECISION::Storage>&);
#define WAVECREST_INSTANTIATE(STAGE, PRECISION, SPECIALIZATION)                                                       \
  template void STAGE<PRECISION, featuresOf(Specialization::SPECIALIZATION)>(const StageContext<PRECISION::Storage>&, \
                                                                             Wave<PRECISION::Storage>&);
