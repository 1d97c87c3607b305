#include "engine/compile/compiled_scene.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>

#include "engine/compile/float_range.h"
#include "engine/compile/materials.h"
#include "engine/compile/scene_geometry.h"
#include "engine/compile/tabulate.h"
#include "engine/scene/scene_error.h"
#include "engine/scene/vector_math.h"
#include "engine/tasks/parallel_for.h"

namespace wavecrest {

uint32_t sceneFeatures(const Scene& scene, bool keeps) {
  uint32_t features = keeps ? uint32_t{kInstances} : 0;
  for (const Shape& shape : scene.shapes) {
    if (shape.material != kNone) features |= materialFeatures(scene.materials[shape.material], scene);
    if (std::holds_alternative<Sphere>(shape.kind)) features |= kCurvedShapes;
    if (std::holds_alternative<Cylinder>(shape.kind)) features |= kShadingNormals;
    if (const Mesh* mesh = std::get_if<Mesh>(&shape.kind); mesh != nullptr && !mesh->normals.empty()) {
      features |= kShadingNormals;
    }
  }
  for (const Emitter& emitter : scene.emitters) {
    // Lights beyond area, point and constant ones.
    if (std::holds_alternative<SpotEmitter>(emitter.kind) || std::holds_alternative<ProjectorEmitter>(emitter.kind) ||
        std::holds_alternative<DirectionalEmitter>(emitter.kind) ||
        std::holds_alternative<EnvmapEmitter>(emitter.kind) || std::holds_alternative<SunskyEmitter>(emitter.kind)) {
      features |= kRareLights;
    }
    // Textures of lights.
    const auto* area = std::get_if<AreaEmitter>(&emitter.kind);
    if (area != nullptr && area->radiance.texture != kNone) features |= kTextures;
    const auto* spot = std::get_if<SpotEmitter>(&emitter.kind);
    if (spot != nullptr && spot->texture != kNone) features |= kTextures;
    const auto* projector = std::get_if<ProjectorEmitter>(&emitter.kind);
    if (projector != nullptr && projector->irradiance.texture != kNone) features |= kTextures;
  }
  return features;
}

bool hasTangents(const Scene& scene) {
  return std::ranges::any_of(scene.shapes, [&](const Shape& shape) {
    return shape.material != kNone && isAnisotropic(scene.materials[shape.material], scene);
  });
}

CameraView compileCamera(const Sensor& sensor, const FilmSettings& film, const Double3& origin) {
  CameraView camera;
  // The film: its size in pixels, and half its extents in camera space, at z = 1 unless rays are parallel.
  camera.width = film.width;
  camera.height = film.height;
  camera.parallel = sensor.kind == Sensor::Kind::orthographic;
  // An orthographic film reaches from -1 to 1.
  const double halfWidth = camera.parallel ? 1 : std::tan(sensor.fovX * std::numbers::pi / 360);
  const double halfHeight = halfWidth * film.height / film.width;
  // The origin and the corner of the picture. Mitsuba's camera looks along +z with +x to the left of the image, so
  // raster x runs against x. Parallel rays begin on the near clip.
  if (camera.parallel) {
    assign(camera.origin, transformPoint(sensor.toWorld, {halfWidth, halfHeight, sensor.nearClip}) - origin);
    assign(camera.corner, {0, 0, 0});
  } else {
    camera.pixelDistance = film.width / (2 * halfWidth);
    assign(camera.origin, transformPoint(sensor.toWorld, {0, 0, 0}) - origin);
    const auto [shiftX, shiftY] = sensor.principalPointOffset;  // in widths and heights of the film
    assign(camera.corner,
           transformVector(sensor.toWorld, {halfWidth * (1 - 2 * shiftX), halfHeight * (1 - 2 * shiftY), 1}));
  }
  // The steps of a pixel, and what projecting onto the film needs.
  assign(camera.du, transformVector(sensor.toWorld, {-2 * halfWidth / film.width, 0, 0}));
  assign(camera.dv, transformVector(sensor.toWorld, {0, -2 * halfHeight / film.height, 0}));
  assign(camera.axis, normalized(transformVector(sensor.toWorld, {0, 0, 1})));
  camera.planeDepth = dot(vec(camera.corner), vec(camera.axis));
  camera.inverseDu2 = 1 / dot(vec(camera.du), vec(camera.du));
  camera.inverseDv2 = 1 / dot(vec(camera.dv), vec(camera.dv));
  // Lens and filter.
  camera.lensRadius = sensor.apertureRadius;
  camera.focusDistance = sensor.focusDistance;
  switch (film.filter) {
    case ReconstructionFilter::box:
      camera.filter = FilterKind::box;
      break;
    case ReconstructionFilter::tent:
      camera.filter = FilterKind::tent;
      camera.filterScale = film.filterRadius;
      break;
    case ReconstructionFilter::gaussian:
      camera.filter = FilterKind::gaussian;
      camera.filterScale = film.gaussianStddev;
      break;
  }
  return camera;
}

CameraView withFilm(const CameraView& camera, const Sensor& sensor, const FilmSettings& film, const Double3& origin) {
  CameraView other = compileCamera(sensor, film, origin);
  other.nearClip = camera.nearClip;
  other.farClip = camera.farClip;
  return other;
}

namespace {

// Bounding box of the space before the near clip and within the picture: of the pyramid from the lens to the near clip.
struct NearBox {
  Double3 low, high;

  NearBox(const CameraView& camera, double nearClip) {
    const Double3 origin = vec(camera.origin);
    low = high = origin;
    // A Gaussian is cut at 4.5 deviations (filterRadius in kernels/scene_view.h).
    const double around = 1 + 4.5 * camera.filterScale;  // pixels; filters reach over the picture's border
    for (const double x : {-around, camera.width + around}) {
      for (const double y : {-around, camera.height + around}) {
        const Double3 onPlane = vec(camera.corner) + vec(camera.du) * x + vec(camera.dv) * y;
        const Double3 point = origin + onPlane * (nearClip / camera.planeDepth);
        for (size_t i = 0; i < 3; ++i) {
          low[i] = std::min(low[i], point[i]);
          high[i] = std::max(high[i], point[i]);
        }
      }
    }
    // Rays start anywhere on the lens, and cross in the focus; the rest covers rounding.
    const double spread = camera.lensRadius > 0 ? std::max(1.0, std::abs(nearClip / camera.focusDistance - 1)) : 0;
    const double margin = camera.lensRadius * spread + nearClip * 1e-3;
    for (size_t i = 0; i < 3; ++i) {
      low[i] -= margin;
      high[i] += margin;
    }
  }
  // Faces count with their bounding box, spheres with their surface.
  bool touches(const PrimitiveRecord<double>& primitive) const {
    if (static_cast<PrimitiveKind>(primitive.kind) == PrimitiveKind::sphere) return touchesSphere(primitive);
    const Extent extent = extentOf(primitive);
    return touches(extent.low, extent.high);
  }
  bool touches(const Double3& boxLow, const Double3& boxHigh) const {
    for (size_t i = 0; i < 3; ++i) {
      if (boxHigh[i] < low[i] || boxLow[i] > high[i]) return false;
    }
    return true;
  }

 private:
  // Whether the box meets the surface of a sphere: its nearest point is inside and its farthest point outside. A box
  // within a sphere does not.
  bool touchesSphere(const PrimitiveRecord<double>& sphere) const {
    double nearest2 = 0, farthest2 = 0;
    for (size_t i = 0; i < 3; ++i) {
      const double below = low[i] - sphere.p0[i], above = high[i] - sphere.p0[i];
      const double outside = std::max({below, -above, 0.0}), across = std::max(std::abs(below), std::abs(above));
      nearest2 += outside * outside;
      farthest2 += across * across;
    }
    const double radius2 = sphere.e1[0] * sphere.e1[0];
    return nearest2 <= radius2 && radius2 <= farthest2;
  }
};

// Throws SceneError where the eye or a light is too far from a large scene for the test of a face. origins: of rays.
void checkReach(const Scene& scene, const BoundingSphere& bounds, const Box& origins) {
  const double radius2 = bounds.radius * bounds.radius;
  const double reach = rayReach(boxOf(Extent{.low = vec(bounds.low), .high = vec(bounds.high)}), origins);
  if (radius2 * reach <= kLargestProduct) return;
  // A third of the reach is the extent of all along an axis.
  throw SceneError(
      SourceLocation{scene.name},
      fmt::format("the scene, its camera and its lights extend over {:g}; expected at most {:g} for a scene "
                  "of radius {:g}",
                  reach / 3, kLargestProduct / radius2 / 3, bounds.radius));
}

// The view of what is compiled, but for the camera and the intersectors: pointers to it, and what kernels decide by.
template <class S>
void completeView(const Scene& scene, uint32_t features, bool keepsInstances, CompiledScene<S>& compiled) {
  SceneView<S>& view = compiled.view;
  const auto& primitives = compiled.primitives;
  const BoundingSphere& bounds = compiled.bounds;
  view.primitives = primitives.records.data();
  view.primitiveCount = static_cast<uint32_t>(primitives.records.size());
  if constexpr (sizeof(S) == sizeof(float)) {
    compiled.primitiveTable = tabulate<PrimitiveTable>(
        std::span<const PrimitiveRecord<S>>(primitives.records.data(), primitives.records.size()));
    view.primitiveTable = compiled.primitiveTable.get();
  }
  view.attributes = primitives.attributes.data();
  if (keepsInstances) view.instances = compiled.instances.data();
  view.instanceCount = static_cast<uint32_t>(compiled.instances.size());
  view.materials = compiled.materials.data();
  if (!compiled.compounds.empty()) view.compounds = compiled.compounds.data();
  if (!compiled.passages.empty()) view.passages = compiled.passages.data();
  view.materialCount = static_cast<uint32_t>(compiled.materials.size());
  view.bsdfKinds = 0;
  for (const MaterialRecord& material : compiled.materials) view.bsdfKinds |= 1u << material.kind;
  // Without kCompoundBsdfs no shape has a compound BSDF, though the scene may list one.
  if (compiled.compounds.empty()) view.bsdfKinds &= ~kCompoundKinds;
  compiled.materialTable = tabulate<MaterialTable>(std::span<const MaterialRecord>(compiled.materials));
  view.materialTable = compiled.materialTable.get();
  view.textures = compiled.textures.records.data();
  view.texels = compiled.textures.texels.data();
  view.environment = compiled.lights.environment.view;
  view.lights = compiled.lights.records.data();
  view.lightTable = compiled.lights.table.data();
  view.lightCount = static_cast<uint32_t>(compiled.lights.records.size());
  view.infiniteLight = compiled.lights.infinite;
  view.hidesInfinite = scene.defaults.hideEmitters;
  view.normalMaps = (features & kNormalMaps) != 0;
  view.tangents = hasTangents(scene);
  view.spheres = primitives.counts.spheres != 0;
  view.firstPrimitive[1] = primitives.counts.quads;
  view.firstPrimitive[2] = primitives.counts.quads + primitives.counts.triangles;
  for (size_t i = 0; i < 3; ++i) {
    view.center[i] = bounds.center[i];
    view.halfExtent[i] = bounds.halfExtent(i);
  }
  view.radius = bounds.radius;
}

}  // namespace

Box rayOrigins(const Scene& scene, const BoundingSphere& bounds, const double (&eye)[3], const Double3& origin,
               double farthestLight) {
  Extent points;
  points.include(vec(eye));
  const Double3 center = vec(bounds.center);
  for (const Emitter& emitter : scene.emitters) {
    const std::optional<Double3> position = positionOf(emitter);
    if (!position) continue;
    const Double3 away = *position - origin - center;
    const double nearer = std::min(1.0, farthestLight * bounds.radius / length(away));
    points.include(center + nearer * away);
  }
  return boxOf(points);
}

void setClips(const Sensor& sensor, const SceneGeometry& geometry, const BoundingSphere& bounds, CameraView& camera) {
  // Near clip: set if a primitive may lie before it. Instances are tested by their boxes first.
  const PrimitiveList& primitives = geometry.world();
  // An orthographic camera's rays begin at the near clip anyway.
  if (!camera.parallel) {
    const NearBox box(camera, sensor.nearClip);
    bool touched = anyIndex(parallelFor, primitives.counts().total(),
                            [&](size_t i) { return box.touches(primitives.corners<double>(i)); });
    for (const BvhInstance& instance : geometry.instances()) {
      if (touched || !box.touches(vec(instance.box.low), vec(instance.box.high))) continue;
      touched = geometry.anyInInstance(instance,
                                       [&](const Double3& low, const Double3& high) { return box.touches(low, high); });
    }
    if (touched) camera.nearClip = sensor.nearClip;
  }
  // Far clip: set if the farthest corner of the scene's box lies beyond it, or may do so but for rounding to float.
  double farthest = 1e-5 * bounds.radius;
  for (size_t i = 0; i < 3; ++i) {
    farthest += ((camera.axis[i] > 0 ? bounds.high[i] : bounds.low[i]) - camera.origin[i]) * camera.axis[i];
  }
  // Parallel rays begin at the near clip, from where their far clip is measured.
  const double farClip = camera.parallel ? sensor.farClip - sensor.nearClip : sensor.farClip;
  if (farthest > farClip) camera.farClip = farClip;
}

template <class S>
std::unique_ptr<CompiledScene<S>> compileScene(const Scene& scene, Accel accel, bool watertightEmbree,
                                               Instancing instancing) {
  auto compiled = std::make_unique<CompiledScene<S>>();
  const bool keeps = keepsInstances(scene, accel, instancing);
  const uint32_t features = sceneFeatures(scene, keeps);
  // Geometry, relative to the kernels' origin.
  SceneGeometry geometry(scene, (features & kTextures) != 0, keeps);
  if (geometry.counts().total() == 0) {
    const SourceLocation where = scene.shapes.empty() ? SourceLocation{scene.name} : scene.shapes.front().source;
    throw SceneError(where, "no shape of the scene has a surface; expected one of positive area");
  }
  BoundingSphere bounds = geometry.bounds<S>();
  const Double3 origin = compiled->origin = originOf(bounds);
  if (origin != Double3{}) {
    geometry.moveTo(origin);
    bounds = geometry.bounds<S>();
  }
  checkFloatRange(scene, bounds.radius, geometry.groupRadii(), keeps);
  compiled->bounds = bounds;
  SceneView<S>& view = compiled->view;
  view.camera = compileCamera(scene.sensor, scene.film, origin);
  checkReach(scene, bounds,
             rayOrigins(scene, bounds, view.camera.origin, origin, std::numeric_limits<double>::infinity()));
  setClips(scene.sensor, geometry, bounds, view.camera);

  // Intersectors first: what they need only while they are built is gone before the records are made.
  const PrimitiveList& world = geometry.world();
  if (accel == Accel::automatic) {
    accel = !keeps && world.counts().total() <= kSmallSceneLimit ? Accel::small : Accel::bvh;
  }
  const Box origins = rayOrigins(scene, bounds, view.camera.origin, origin);
  if (accel == Accel::small) {
    std::vector<PrimitiveRecord<double>> precise(world.counts().total());
    for (size_t i = 0; i < precise.size(); ++i) precise[i] = world.geometry<double>(i);
    compiled->small = std::make_unique<SmallScene>(precise.data(), precise.size(), origins);
    view.small = &compiled->small->view();
  } else if (accel == Accel::bvh) {
    compiled->bvh =
        std::make_unique<Bvh>(world.source(), geometry.groups(), geometry.instances(), origins, parallelFor);
    view.bvh = &compiled->bvh->view();
  }
  // Records of primitives and instances. Embree is built from the former.
  auto& primitives = compiled->primitives = geometry.compile<S>();
  compiled->instances = geometry.compileInstances<S>();
  if (accel == Accel::embree) {
    compiled->embree =
        std::make_unique<EmbreeScene>(primitives.records.data(), primitives.counts.quads, primitives.counts.triangles,
                                      primitives.counts.spheres, watertightEmbree);
    view.embree = compiled->embree->handle();
  }

  // Lights, materials and textures.
  compiled->lights = compileLights(scene, bounds, primitives, origin);
  CompiledMaterials materials = compileMaterials(scene, (features & kCompoundBsdfs) != 0);
  if (materials.withoutPassages != 0) {
    for (size_t i = 0; i < primitives.shapeOf.size(); ++i) {
      if (primitives.shapeOf[i] != kNone) primitives.records[i].material += materials.withoutPassages;
    }
  }
  compiled->materials = std::move(materials.records);
  compiled->compounds = std::move(materials.compounds);
  compiled->passages = std::move(materials.passages);

  compiled->textures = compileTextures(scene);
  bindLightTextures(scene, primitives, compiled->lights, compiled->textures);

  completeView(scene, features, keeps, *compiled);
  return compiled;
}
template std::unique_ptr<CompiledScene<float>> compileScene(const Scene&, Accel, bool, Instancing);
template std::unique_ptr<CompiledScene<double>> compileScene(const Scene&, Accel, bool, Instancing);

}  // namespace wavecrest
