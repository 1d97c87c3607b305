// The scene as kernels see it: flat arrays of fixed-size records in plain memory, built once by the engine.
//
// Records are arrays of words so that lanes can gather any field; the k*Word constants name the fields. S is float, or
// double for the `double` precision policy.
#pragma once

#include <cstddef>
#include <cstdint>

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
constexpr uint32_t kNoIndex = 0xffffffffu;

// Vertex normals and texture coordinates at (u, v) = (0, 0), (1, 0) and (0, 1) of a triangle or quad.
struct alignas(64) AttributeRecord {
  float normal[3][3];
  float uv[3][2];
  uint32_t hasNormals;
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
  phong
};

enum MaterialFlags : uint32_t { kTwoSided = 1 };

// Slots of a material that may be textured: the constant in the record is then multiplied by the texture's value.
struct alignas(128) MaterialRecord {
  uint32_t kind;           // BsdfKind
  uint32_t flags;          // MaterialFlags
  float reflectance[3];    // diffuse albedo
  float specular[3];       // specular reflectance factor
  float transmittance[3];  // specular transmittance factor
  float eta[3], k[3];      // conductor: complex IOR; dielectric, plastic: eta[0] = interior / exterior
  float alpha;             // GGX roughness, or Phong exponent
  float specularPick;      // plastic, phong: probability weight of the specular lobe
  float internalDiffuse;   // plastic: diffuse Fresnel reflectance from inside
  float nonlinear;         // plastic: 1 where internal scattering shifts colour
  float opacity;
  uint32_t reflectanceTexture, specularTexture, alphaTexture, opacityTexture, normalTexture, bumpTexture;
};

enum class LightKind : uint32_t { quad, triangle, sphere, point, spot, directional, constant, envmap };

// quad, triangle: y = p0 + u e1 + v e2, normal; area in `area`. sphere: centre p0, radius. point, spot: p0. infinite
// lights: direction of travel in `normal` (directional).
template <class S>
struct alignas(sizeof(S) * 32) LightRecord {
  S p0[3], e1[3], e2[3], normal[3];
  S radiance[3];  // radiance, intensity or perpendicular irradiance
  S pick;         // probability that light selection takes this light
  S inverseArea;  // 1 / area of an area light
  S radius;
  S offset;  // bound on the error of a sampled point along the normal
  S cosTotal, cosFalloff;
  uint32_t kind;  // LightKind
};

// Alias table: entry i is kept with probability `keep`, else replaced by `other` (Walker 1977, Vose 1991).
struct AliasEntry {
  float keep;
  uint32_t other;
};

// Raster (x, y) maps to the direction corner + x * du + y * dv, not normalised. METHODS: D is the distance in pixels at
// which a pixel has area 1.
struct CameraView {
  double origin[3], corner[3], du[3], dv[3], axis[3];
  uint32_t width = 0, height = 0;  // of the full film
  double pixelDistance = 0;
  double lensRadius = 0, focusDistance = 0;
};

struct SmallSceneView;  // kernels/extend/small_scene.h

template <class S>
struct SceneView {
  const PrimitiveRecord<S>* primitives = nullptr;
  const AttributeRecord* attributes = nullptr;
  const MaterialRecord* materials = nullptr;
  const LightRecord<S>* lights = nullptr;
  const AliasEntry* lightTable = nullptr;
  uint32_t lightCount = 0;
  uint32_t infiniteLight = kNoIndex;  // the constant or environment light that rays leaving the scene see
  bool spheres = false;               // some primitive is a sphere
  double center[3]{}, radius = 0;     // bounding sphere
  CameraView camera;
  const SmallSceneView* small = nullptr;
  void* embree = nullptr;        // RTCScene
  uint32_t firstPrimitive[3]{};  // of the quads, triangles and spheres in `primitives`
};

}  // namespace wavecrest
