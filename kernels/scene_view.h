// The scene as kernels see it: flat arrays of fixed-size records in plain memory, built once by the engine.
//
// Records consist of 32-bit words, or of doubles, so that lanes can gather any field (RecordLanes in lane_support.h). S
// is float, or double for the `double` precision policy.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "kernels/columns/records.h"

namespace wavecrest {

enum class PrimitiveKind : uint32_t { triangle, quad, sphere };

// triangle, quad: point(u, v) = p0 + u e1 + v e2, with u + v <= 1 for a triangle and u, v in [0, 1] for a quad; the
//   normal is the unit vector along e1 x e2.
// sphere: centre p0, radius e1.x; the normal is outward times e1.y (+1 or -1).
template <class S>
struct alignas(sizeof(S) * 16) PrimitiveRecord {
  S p0[3], e1[3], e2[3], normal[3];
  uint32_t material;    // index into SceneView::materials
  uint32_t light;       // index into SceneView::lights, or kNoIndex
  uint32_t kind;        // PrimitiveKind
  uint32_t attributes;  // index into SceneView::attributes, or kNoIndex
};

// Vertex normals and texture coordinates at (u, v) = (0, 0), (1, 0) and (0, 1) of a triangle or quad.
struct alignas(64) AttributeRecord {
  float normal[3][3];
  float uv[3][2];
  uint32_t hasNormals;
};

// A group of shapes in its place: a point p of the group is at place + toWorld p, and toObject is the inverse of
// toWorld. Affine, of either handedness. Normals of a group are on the side that they are on in the group.
template <class S>
struct alignas(sizeof(S) * 32) InstanceRecord {
  S place[3], toWorld[3][3], toObject[3][3];  // matrices by rows
};

enum class BsdfKind : uint32_t {
  diffuse,
  conductor,
  roughConductor,
  dielectric,
  thinDielectric,
  roughDielectric,
  plastic,
  roughPlastic,
  phong,
  beckmannConductor,  // the rough kinds with Beckmann's distribution of normals instead of GGX
  beckmannDielectric,
  beckmannPlastic,
  // Compound BSDFs, whose other numbers are in a CompoundRecord.
  anisotropicConductor,  // rough kinds with two roughnesses, along dp/du and across
  anisotropicDielectric,
  anisotropicBeckmannConductor,
  anisotropicBeckmannDielectric,
  principled,
  principledThin,
  blend,
  deltaBlend  // of BSDFs with delta lobes alone
};
constexpr uint32_t bitOf(BsdfKind kind) { return 1u << static_cast<uint32_t>(kind); }
constexpr uint32_t kBlendKinds = bitOf(BsdfKind::blend) | bitOf(BsdfKind::deltaBlend);
constexpr uint32_t kCompoundKinds = kBlendKinds | bitOf(BsdfKind::principled) | bitOf(BsdfKind::principledThin) |
                                    bitOf(BsdfKind::anisotropicConductor) | bitOf(BsdfKind::anisotropicDielectric) |
                                    bitOf(BsdfKind::anisotropicBeckmannConductor) |
                                    bitOf(BsdfKind::anisotropicBeckmannDielectric);

enum MaterialFlags : uint32_t {
  kTwoSided = 1,   // the back looks like the front
  kHasDelta = 2,   // some lobe is a delta: smooth reflection or refraction, or opacity below 1
  kHasFinite = 4,  // some lobe is not
  kNonlinear = 8,  // plastic: internal scattering shifts colour
  // Of materials with a bump or normal map (kernels/surface/normal_map_lanes.h).
  kMapped = 16,
  kFlipsNormals = 32,
  kSoftensTerminator = 64,
  kMirrorsBack = 128,  // instead of kTwoSided where two-sidedness is around the map
  // Light goes straight on through it: its PassageRecord says how much. Its BSDF is that of the rest of the surface,
  // with an opacity of 1.
  kPasses = 256,
};

// Roughness below which a surface is treated as smooth: lobes narrower than about 0.1 degrees.
constexpr float kSmallestAlpha = 1e-3f;

// Entries of a rough plastic's transmittance, at cos theta = i / (kTransmittanceSize - 1).
constexpr uint32_t kTransmittanceSize = 64;

// Slots of a material that may be textured hold 1, or a constant by which the texture's value is multiplied.
struct alignas(128) MaterialRecord {
  float reflectance[3];    // diffuse albedo
  uint32_t flags;          // MaterialFlags; here, because lanes read both at once
  uint32_t kind;           // BsdfKind
  float specular[3];       // specular reflectance factor
  float transmittance[3];  // specular transmittance factor
  float eta[3], k[3];      // conductor: complex IOR; dielectric, plastic: eta[0] = interior / exterior
  float alpha;             // microfacet roughness, or Phong exponent
  float specularPick;      // plastic, phong: share of the specular lobe before its reflectance is considered
  float internalDiffuse;   // plastic: reflectance of the boundary for diffuse light from inside
  float opacity;
  uint32_t reflectanceTexture, specularTexture, transmittanceTexture, alphaTexture, opacityTexture;
  uint32_t normalTexture, bumpTexture;
  float bumpScale;
  float roughTransmittance[kTransmittanceSize];  // rough plastic: share of light that enters, shadowing included
};

// Parameters of compound BSDFs, by Mitsuba 3's names, that are constants or textures. Those of principled BSDFs that
// are also in a MaterialRecord: base_color is its reflectance, roughness its alpha, eta its eta[0].
enum class CompoundParameter : uint32_t {
  alphaV,  // of anisotropic kinds, across dp/du; alpha is along it
  anisotropic,
  metallic,
  specTrans,
  specTint,
  sheen,
  sheenTint,
  flatness,
  clearcoat,
  clearcoatGloss,
  diffTrans
};
constexpr size_t kCompoundParameters = 11;

constexpr uint32_t kMostParts = 8;

// What a compound BSDF has that is not in its MaterialRecord. `parts` of a blend are materials without bump and normal
// maps that are no blends themselves; f is the sum of theirs, times their weights. With a weight texture t there are
// two parts, with weights 1 - t and t.
struct alignas(64) CompoundRecord {
  float value[kCompoundParameters];  // 1 where there is a texture
  uint32_t texture[kCompoundParameters];
  uint32_t partCount, part[kMostParts];
  float weight[kMostParts];
  uint32_t weightTexture;
};

// How much light goes straight on through a material of kPasses that is no blend (METHODS 3.10): what the opacity
// leaves; and where `matched` is 1, for it is a boundary between equal indices, the rest as well, times the tint.
struct alignas(32) PassageRecord {
  float opacity;  // 1 where it has a texture
  uint32_t opacityTexture;
  float tint[3];
  uint32_t tintTexture, matched;
};

// A vertex keeps its material and its depth in one number of 32 bits.
constexpr uint32_t kMaterialBits = 20, kMaxMaterials = 1u << kMaterialBits,
                   kMostEdges = (1u << (32 - kMaterialBits)) - 1;

// The first words of few records: word w of record r at [w][r]. A block of lanes has a word of all of them in some
// registers of its own width, and looks its own up there.
template <size_t kWordsOfRecord, size_t kMostRegisters>
struct alignas(64) RecordTable {
  static constexpr size_t kWords = kWordsOfRecord, kRegisters = kMostRegisters;
  static constexpr size_t kRecords = 16 * kRegisters;  // 16: the widest block of lanes
  uint32_t words[kWords][kRecords];
};
// Without the last array of a record.
using MaterialTable = RecordTable<offsetof(MaterialRecord, roughTransmittance) / sizeof(uint32_t), 1>;
using PrimitiveTable = RecordTable<sizeof(PrimitiveRecord<float>) / sizeof(uint32_t), 2>;

enum class TextureKind : uint32_t { checkerboard, bitmap };
enum class WrapMode : uint32_t { repeat, mirror, clamp };

// Bitmaps are RGB floats from the top row, `offset` floats into SceneView::texels. toUv maps (u, v, 1) to texture
// space.
struct alignas(128) TextureRecord {
  uint32_t kind;  // TextureKind
  uint32_t width, height, offset;
  uint32_t wrap;     // WrapMode
  uint32_t nearest;  // 1: no interpolation
  float toUv[6];
  float color0[3], color1[3];
};

enum class LightKind : uint32_t { quad, triangle, sphere, point, spot, directional, constant, envmap, projector };

// quad, triangle: y = p0 + u e1 + v e2, normal. sphere: centre p0, radius, e1.y as in its primitive. point: p0. spot,
// projector: p0, axis in `normal`; on the plane at distance 1 along it the picture, of a spot's texture or a projector,
// is where |dot(e1, place)| and |dot(e2, place)| are at most 1. infinite lights: direction of travel in `normal`
// (directional).
template <class S>
struct alignas(sizeof(S) * 32) LightRecord {
  S p0[3], e1[3], e2[3], normal[3];
  S radiance[3];  // radiance, intensity or perpendicular irradiance
  S pick;         // probability that light selection takes this light
  S inverseArea;  // 1 / area of an area light, or of a projector's picture
  S radius;
  S offset;                    // bound on the error of a sampled point along the normal
  S cutoffHeight, beamHeight;  // of a spot, 1 - cos of the angles
  uint32_t kind;               // LightKind
  uint32_t texture;            // factor of the radiance of an area light, a spot or a projector, or kNoIndex
};

// Alias table: entry i is kept with probability `keep`, else replaced by `other` (Walker 1977, Vose 1991).
struct AliasEntry {
  float keep;
  uint32_t other;
};

enum class FilterKind : uint32_t { box, tent, gaussian };

// Raster (x, y) maps to the direction corner + x * du + y * dv, not normalised, from the origin; of parallel rays,
// which all go along the axis, to their origin, origin + x * du + y * dv. du, dv and the axis are perpendicular to each
// other.
struct CameraView {
  static constexpr double kNoClip = std::numeric_limits<double>::infinity();
  double origin[3], corner[3], du[3], dv[3], axis[3];
  uint32_t width = 0, height = 0;         // of the full film
  bool parallel = false;                  // an orthographic camera
  double pixelDistance = 0;               // METHODS: D, the distance in pixels at which a pixel has area 1
  double planeDepth = 0;                  // corner . axis
  double inverseDu2 = 0, inverseDv2 = 0;  // 1 / |du|^2, 1 / |dv|^2
  double lensRadius = 0, focusDistance = 0;
  // Along the axis from the lens, or from the origin of parallel rays: what lies outside is not seen. 0 and infinite
  // where the scene has nothing there.
  double nearClip = 0, farClip = kNoClip;
  FilterKind filter = FilterKind::box;  // sampled by importance
  double filterScale = 0;               // radius of the tent, standard deviation of the Gaussian, in pixels
};

// How far a filter reaches from the centre of a pixel. A Gaussian's rest beyond four and a half deviations is below
// 1e-5.
inline double filterRadius(const CameraView& camera) {
  if (camera.filter == FilterKind::box) return 0.5;
  return camera.filter == FilterKind::tent ? camera.filterScale : 4.5 * camera.filterScale;
}

// Bits of a texel's column and of its row in the alias table of an environment.
constexpr uint32_t kTexelBits = 16, kMostTexelsAcross = 1u << kTexelBits;

// A latitude-longitude environment, of up to kMostTexelsAcross columns and rows. `table` has an entry for each texel,
// row by row, whose `other` is a column and, kTexelBits higher, a row. Sampled by texel with probability[texel], then
// uniformly within; the texel of (u, v) is (floor(u width), floor(v height)). Radiance is interpolated as Mitsuba does:
// columns by their centres and around, rows from pole to pole.
//
// A sky has nothing below its horizon, the middle of the map, and may have a sun: a disc of even radiance in front of
// the map, sampled uniformly with probability sunShare.
struct EnvironmentView {
  const float* texels = nullptr;  // RGB, radiance scale included
  const float* probability = nullptr;
  const AliasEntry* table = nullptr;
  uint32_t width = 0, height = 0;
  float toLocal[3][3]{};  // rows: world to the map's frame, orthonormal
  bool isSky = false;
  float sunShare = 0;        // 0: no sun
  double sunDirection[3]{};  // from the scene, in the world
  double sunChord2 = 0;      // squared distance of unit vectors to the sun's middle and rim, 2 (1 - cos)
  double sunRadiance[3]{};
};

template <class S>
struct StageContext;  // kernels/stages.h
template <class S>
struct Wave;            // kernels/columns/wave.h
struct SmallSceneView;  // kernels/extend/small_scene.h
struct BvhView;         // kernels/extend/bvh.h

template <class S>
struct SceneView {
  const PrimitiveRecord<S>* primitives = nullptr;
  const AttributeRecord* attributes = nullptr;
  const InstanceRecord<S>* instances = nullptr;  // null in scenes without instances, or where they are copies
  const MaterialRecord* materials = nullptr;
  const CompoundRecord* compounds = nullptr;  // of each material; null in scenes without compound BSDFs
  // Of each material; null in scenes through whose surfaces no light goes straight on.
  const PassageRecord* passages = nullptr;
  // Of scenes with passages: extend and occlude of the scene's intersector, which those with passages are made of.
  void (*closestHits)(const StageContext<S>&, Wave<S>&) = nullptr;
  void (*blockedRays)(const StageContext<S>&, Wave<S>&) = nullptr;
  // The same, if they are few; of primitives in float alone.
  const PrimitiveTable* primitiveTable = nullptr;
  const MaterialTable* materialTable = nullptr;
  uint32_t primitiveCount = 0;  // those of the world, then those of each group
  uint32_t instanceCount = 0;
  uint32_t materialCount = 0;
  uint32_t bsdfKinds = ~0u;  // bit k: some material is, or may be, of BsdfKind k
  const LightRecord<S>* lights = nullptr;
  const TextureRecord* textures = nullptr;
  const float* texels = nullptr;
  EnvironmentView environment;
  const AliasEntry* lightTable = nullptr;
  uint32_t lightCount = 0;
  uint32_t infiniteLight = kNoIndex;  // the constant or environment light that rays leaving the scene see
  bool hidesInfinite = false;         // not the first of a camera path
  bool spheres = false;               // some primitive is a sphere
  bool normalMaps = false;            // some material has a bump or normal map
  bool tangents = false;              // some BSDF depends on the direction of dp/du
  double center[3]{}, radius = 0;     // bounding sphere
  double halfExtent[3]{};             // of the box around the same centre that light from far away enters by
  CameraView camera;
  const SmallSceneView* small = nullptr;  // one of these three
  const BvhView* bvh = nullptr;
  void* embree = nullptr;        // RTCScene
  uint32_t firstPrimitive[3]{};  // of the quads, triangles and spheres in `primitives`
};

}  // namespace wavecrest
