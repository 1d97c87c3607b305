#include "engine/compile/lights.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <unordered_map>

#include "engine/compile/pick_table.h"
#include "engine/compile/sky.h"
#include "engine/scene/scene_error.h"
#include "engine/scene/vector_math.h"
#include "kernels/extend/offset.h"

namespace wavecrest {
namespace {

// Share of the light picks that goes to all emitters alike, except black ones. An emitter's power says little about
// what reaches one place: a lamp above a table may give it as much as the sky does, with a thousandth of the sky's
// power.
constexpr double kEvenShare = 0.5;

template <class S>
Double3 widenedRecord(const S (&a)[3]) {
  return {a[0], a[1], a[2]};
}

// Surface area; the radius of a sphere is e1[0].
template <class S>
double areaOf(const PrimitiveRecord<S>& primitive) {
  if (static_cast<PrimitiveKind>(primitive.kind) == PrimitiveKind::sphere) {
    return 4 * std::numbers::pi * primitive.e1[0] * primitive.e1[0];
  }
  const double parallelogram = length(cross(widenedRecord(primitive.e1), widenedRecord(primitive.e2)));
  return static_cast<PrimitiveKind>(primitive.kind) == PrimitiveKind::quad ? parallelogram : parallelogram / 2;
}

Double3 positionOf(const ProjectorEmitter& projector) {
  const Matrix4& m = projector.toWorld;
  return {m[0][3], m[1][3], m[2][3]};
}

// The light of one emitting primitive, without its pick and texture.
template <class S>
LightRecord<S> areaLight(const PrimitiveRecord<S>& primitive, const Rgb& radiance) {
  LightRecord<S> light{};
  std::copy(std::begin(primitive.p0), std::end(primitive.p0), light.p0);
  std::copy(std::begin(primitive.e1), std::end(primitive.e1), light.e1);
  std::copy(std::begin(primitive.e2), std::end(primitive.e2), light.e2);
  std::copy(std::begin(primitive.normal), std::end(primitive.normal), light.normal);
  assign(light.radiance, radiance);
  light.inverseArea = static_cast<S>(1 / areaOf(primitive));
  // Bound on a sampled point's error along its normal: kOffsetGamma times the magnitudes that are added on each axis,
  // summed over the axes (offset.h).
  Double3 extent{};
  const bool sphere = static_cast<PrimitiveKind>(primitive.kind) == PrimitiveKind::sphere;
  for (size_t i = 0; i < 3; ++i) {
    const S reach = sphere ? primitive.e1[0] : std::abs(primitive.e1[i]) + std::abs(primitive.e2[i]);
    extent[i] = std::abs(primitive.p0[i]) + reach;
  }
  light.offset = static_cast<S>(kOffsetGamma * (extent[0] + extent[1] + extent[2]));
  switch (static_cast<PrimitiveKind>(primitive.kind)) {
    case PrimitiveKind::quad:
      light.kind = static_cast<uint32_t>(LightKind::quad);
      break;
    case PrimitiveKind::triangle:
      light.kind = static_cast<uint32_t>(LightKind::triangle);
      break;
    case PrimitiveKind::sphere:
      light.kind = static_cast<uint32_t>(LightKind::sphere);
      light.radius = primitive.e1[0];
      break;
  }
  return light;
}

// Collects the records with their power (luminance of the flux onto the scene) and their emitter, which decide how
// often each is picked.
template <class S>
class LightCollector {
  static constexpr size_t kMostLights = std::min<size_t>(kMostIndexed<LightRecord<S>>, kPickNumbers);

 public:
  LightCollector(const Scene& scene, const BoundingSphere& bounds, const Double3& origin)
      : scene_(scene), bounds_(bounds), origin_(origin) {}

  // One light for each primitive of an emitting shape. The power is the flux of a one-sided diffuse emitter.
  void addPrimitives(Primitives<S>& primitives) {
    for (size_t i = 0; i < primitives.shapeOf.size(); ++i) {
      const uint32_t shape = primitives.shapeOf[i];
      if (shape == kNone) continue;
      const Emitter& emitter = scene_.emitters[scene_.shapes[shape].emitter];
      const Rgb& radiance = std::get<AreaEmitter>(emitter.kind).radiance.value;
      primitives.records[i].light = static_cast<uint32_t>(lights_.records.size());
      LightRecord<S> light = areaLight(primitives.records[i], radiance);
      light.texture = std::get<AreaEmitter>(emitter.kind).radiance.texture;
      // A textured light is picked as if its radiance were 1. The estimate is unbiased for any positive pick.
      if (light.texture != kNone) assign(light.radiance, {1, 1, 1});
      const double brightness = light.texture == kNone ? luminance(radiance) : 1.0;
      emitter_ = shape;
      add(light, std::numbers::pi * areaOf(primitives.records[i]) * brightness);
    }
  }

  // The lights without a shape. Area emitters are in the list as well and add nothing here.
  void addOthers() {
    emitter_ = static_cast<uint32_t>(scene_.shapes.size());
    for (const Emitter& emitter : scene_.emitters) {
      location_ = emitter.source;
      ++emitter_;
      std::visit([&](const auto& kind) { visit(kind); }, emitter.kind);
    }
  }

  // From powers to picks.
  Lights<S> finish() {
    // Power and number of records of each emitter.
    std::vector<double> power(lights_.emitters, 0), records(lights_.emitters, 0);
    for (size_t i = 0; i < power_.size(); ++i) {
      power[lights_.emitterOf[i]] += power_[i];
      ++records[lights_.emitterOf[i]];
    }
    // Each record's share of its emitter. The records of a black emitter share evenly.
    for (size_t i = 0; i < power_.size(); ++i) {
      const uint32_t emitter = lights_.emitterOf[i];
      lights_.withinEmitter.push_back(power[emitter] > 0 ? power_[i] / power[emitter] : 1 / records[emitter]);
    }
    // The emitters' shares of all picks.
    if (lights_.emitters != 0) {
      PickedLights<S> picked = withPicks(lights_, evenedShares(power, kEvenShare, EvenAmong::lit));
      lights_.records = std::move(picked.records);
      lights_.table = std::move(picked.table);
    }
    return std::move(lights_);
  }

 private:
  // Adds a record of the emitter that `emitter_` names.
  void add(const LightRecord<S>& light, double power) {
    if (lights_.records.size() >= kMostLights) {
      throw SceneError({scene_.name},
                       "more than " + std::to_string(kMostLights) + " primitives that emit light; expected fewer");
    }
    lights_.records.push_back(light);
    power_.push_back(power);
    const auto number = static_cast<uint32_t>(numbers_.size());
    lights_.emitterOf.push_back(numbers_.try_emplace(emitter_, number).first->second);
    lights_.emitters = numbers_.size();
  }

  void visit(const AreaEmitter&) {}  // by primitive
  // The visitors below add a light each. The power is the luminance of the flux.
  void visit(const PointEmitter& point) {
    LightRecord<S> light = blank();
    assign(light.p0, point.position - origin_);
    assign(light.radiance, point.intensity);
    light.kind = static_cast<uint32_t>(LightKind::point);
    add(light, 4 * std::numbers::pi * luminance(point.intensity));
  }
  void visit(const SpotEmitter& spot) {
    LightRecord<S> light = blank();
    assign(light.p0, spot.position - origin_);
    assign(light.normal, spot.direction);
    assign(light.radiance, spot.intensity);
    // 1 - cos of an angle in degrees, without the rounding of the cosine.
    const auto heightOf = [](double angle) { return 2 * std::pow(std::sin(angle * std::numbers::pi / 360), 2); };
    const double cutoffHeight = heightOf(spot.cutoffAngle), beamHeight = heightOf(spot.beamWidth);
    light.cutoffHeight = static_cast<S>(cutoffHeight);
    light.beamHeight = static_cast<S>(beamHeight);
    light.kind = static_cast<uint32_t>(LightKind::spot);
    if (spot.texture != kNone) {  // its square touches the circle of the cutoff
      light.texture = spot.texture;
      const double half = std::tan(spot.cutoffAngle * std::numbers::pi / 180);
      assign(light.e1, pictureAxis(spot.toWorld, 0, half));
      assign(light.e2, pictureAxis(spot.toWorld, 1, half));
    }
    // The flux as if full intensity ended halfway, in cosine, between the beam and the cutoff.
    add(light, 2 * std::numbers::pi * (cutoffHeight + beamHeight) / 2 * luminance(spot.intensity));
  }
  void visit(const ProjectorEmitter& projector) {
    LightRecord<S> light = blank();
    const Matrix4& m = projector.toWorld;
    // Half the width and height of the picture on the plane at distance 1. Its irradiance there is `radiance`.
    const double halfWidth = std::tan(projector.fovX * std::numbers::pi / 360),
                 halfHeight = halfWidth / projector.aspect;
    const double area = 4 * halfWidth * halfHeight;
    const bool textured = projector.irradiance.texture != kNone;
    const Rgb irradiance = textured ? Rgb{1, 1, 1} : projector.irradiance.value;
    assign(light.p0, positionOf(projector) - origin_);
    assign(light.normal, normalized(column(m, 2)));
    // As in a camera, x points to the left of the picture and y up; u points right and v down.
    assign(light.e1, -1.0 * pictureAxis(m, 0, halfWidth));
    assign(light.e2, -1.0 * pictureAxis(m, 1, halfHeight));
    assign(light.radiance, (std::numbers::pi * projector.scale) * irradiance);
    light.inverseArea = static_cast<S>(1 / area);
    light.texture = projector.irradiance.texture;
    light.kind = static_cast<uint32_t>(LightKind::projector);
    add(light, std::numbers::pi * projector.scale * luminance(irradiance) * area);
  }
  void visit(const DirectionalEmitter& directional) {
    LightRecord<S> light = blank();
    assign(light.normal, directional.direction);
    assign(light.radiance, directional.irradiance);
    light.kind = static_cast<uint32_t>(LightKind::directional);
    // The flux through the scene's box: perpendicular irradiance times the box's projected area.
    double area = 0;
    for (size_t axis = 0; axis < 3; ++axis) area += std::abs(directional.direction[axis]) * faceArea(axis);
    add(light, area * luminance(directional.irradiance));
  }
  void visit(const ConstantEmitter& constant) {
    LightRecord<S> light = blank();
    assign(light.radiance, constant.radiance);
    light.kind = static_cast<uint32_t>(LightKind::constant);
    addInfinite(light, luminance(constant.radiance));
  }
  void visit(const EnvmapEmitter& envmap) {
    LightRecord<S> light = blank();
    light.kind = static_cast<uint32_t>(LightKind::envmap);
    // The alias table keeps columns and rows in kTexelBits each.
    if (envmap.bitmap->width > kMostTexelsAcross || envmap.bitmap->height > kMostTexelsAcross) {
      throw SceneError(location_, "environment map of more than " + std::to_string(kMostTexelsAcross) +
                                      " columns or rows; expected a smaller one");
    }
    lights_.environment = compileEnvironment(envmap, location_);
    addInfinite(light, lights_.environment.meanLuminance);
  }
  void visit(const SunskyEmitter& sunsky) {
    LightRecord<S> light = blank();
    light.kind = static_cast<uint32_t>(LightKind::envmap);
    lights_.environment = compileSky(sunsky);
    addInfinite(light, lights_.environment.meanLuminance);
  }

  void addInfinite(const LightRecord<S>& light, double meanLuminance) {
    if (lights_.infinite != kNoIndex) {
      throw SceneError(location_, "a second environment emitter; expected at most one");
    }
    lights_.infinite = static_cast<uint32_t>(lights_.records.size());
    // The flux onto a plane whose area is the box's projected area, averaged over directions: a quarter of its surface
    // (Cauchy's formula). The flux through the box is four times that, but most of it leaves again without meeting a
    // surface, and BSDF sampling finds the rest of the sky as well.
    const double across = (faceArea(0) + faceArea(1) + faceArea(2)) / 2;
    add(light, std::numbers::pi * across * meanLuminance);
  }
  // Area of a face, across an axis, of the box that light from far away enters by.
  double faceArea(size_t axis) const {
    return 4 * bounds_.halfExtent((axis + 1) % 3) * bounds_.halfExtent((axis + 2) % 3);
  }
  static Double3 column(const Matrix4& m, size_t i) { return {m[0][i], m[1][i], m[2][i]}; }
  // Vector whose product with a point of the plane at distance 1 along z is -1 and 1 at the sides of a picture that is
  // 2 `half` wide along axis i. Scales of the transform cancel, since pictures are defined in its space; its columns
  // are perpendicular.
  static Double3 pictureAxis(const Matrix4& toWorld, size_t i, double half) {
    const Double3 axis = column(toWorld, i);
    return (length(column(toWorld, 2)) / (dot(axis, axis) * half)) * axis;
  }
  // A light without a texture; the caller sets the kind.
  static LightRecord<S> blank() {
    LightRecord<S> light{};
    light.texture = kNoIndex;
    return light;
  }

  const Scene& scene_;
  const BoundingSphere& bounds_;
  const Double3 origin_;
  Lights<S> lights_;
  std::vector<double> power_;
  uint32_t emitter_ = 0;  // of the records that are added: their shape, or for lights without one a number above
  std::unordered_map<uint32_t, uint32_t> numbers_;  // Lights::emitterOf by that
  SourceLocation location_;
};

}  // namespace

namespace {

// Makes toUv start from a primitive's own (u, v): first the affine map to the texture coordinates at the corners, uv[0]
// + u (uv[1] - uv[0]) + v (uv[2] - uv[0]), then the old toUv.
template <class S>
void composeWithCorners(const PrimitiveRecord<S>& primitive, const RecordArray<AttributeRecord>& attributes,
                        float (&toUv)[6]) {
  if (primitive.attributes == kNoIndex) return;
  const auto& uv = attributes[primitive.attributes].uv;
  for (size_t row = 0; row < 2; ++row) {
    float* const m = toUv + 3 * row;
    const float s = m[0], t = m[1];
    m[0] = s * (uv[1][0] - uv[0][0]) + t * (uv[1][1] - uv[0][1]);
    m[1] = s * (uv[2][0] - uv[0][0]) + t * (uv[2][1] - uv[0][1]);
    m[2] += s * uv[0][0] + t * uv[0][1];
  }
}

}  // namespace

std::optional<Double3> positionOf(const Emitter& emitter) {
  if (const auto* point = std::get_if<PointEmitter>(&emitter.kind)) return point->position;
  if (const auto* spot = std::get_if<SpotEmitter>(&emitter.kind)) return spot->position;
  if (const auto* projector = std::get_if<ProjectorEmitter>(&emitter.kind)) return positionOf(*projector);
  return std::nullopt;
}

template <class S>
void bindLightTextures(const Scene& scene, const Primitives<S>& primitives, Lights<S>& lights, Textures& textures) {
  for (size_t i = 0; i < primitives.shapeOf.size(); ++i) {
    const PrimitiveRecord<S>& primitive = primitives.records[i];
    if (primitive.light == kNoIndex || lights.records[primitive.light].texture == kNoIndex) continue;
    if (static_cast<PrimitiveKind>(primitive.kind) == PrimitiveKind::sphere) {
      throw SceneError(scene.shapes[primitives.shapeOf[i]].source,
                       "textured radiance on a sphere is not supported; expected a rectangle, a disk or a mesh");
    }
    uint32_t& texture = lights.records[primitive.light].texture;
    // A copy, since push_back may move the records.
    TextureRecord record = textures.records[texture];
    composeWithCorners(primitive, primitives.attributes, record.toUv);
    texture = static_cast<uint32_t>(textures.records.size());
    textures.records.push_back(record);
  }
}
template void bindLightTextures(const Scene&, const Primitives<float>&, Lights<float>&, Textures&);
template void bindLightTextures(const Scene&, const Primitives<double>&, Lights<double>&, Textures&);

template <class S>
Lights<S> compileLights(const Scene& scene, const BoundingSphere& bounds, Primitives<S>& primitives,
                        const Double3& origin) {
  LightCollector<S> collector(scene, bounds, origin);
  collector.addPrimitives(primitives);
  collector.addOthers();
  return collector.finish();
}
template Lights<float> compileLights(const Scene&, const BoundingSphere&, Primitives<float>&, const Double3&);
template Lights<double> compileLights(const Scene&, const BoundingSphere&, Primitives<double>&, const Double3&);

template <class S>
PickedLights<S> withPicks(const Lights<S>& lights, const std::vector<double>& shares) {
  std::vector<double> picks(lights.records.size());
  for (size_t i = 0; i < picks.size(); ++i) picks[i] = lights.withinEmitter[i] * shares[lights.emitterOf[i]];
  PickedLights<S> picked{.records = lights.records, .table = makeAliasTable(picks)};
  const std::vector<double> drawn = sharesOf(picked.table, entryShares(picks.size()));
  for (size_t i = 0; i < drawn.size(); ++i) picked.records[i].pick = static_cast<S>(drawn[i]);
  return picked;
}
template PickedLights<float> withPicks(const Lights<float>&, const std::vector<double>&);
template PickedLights<double> withPicks(const Lights<double>&, const std::vector<double>&);

std::vector<double> evenedShares(const std::vector<double>& weights, double even, EvenAmong among) {
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  // Weights that are all 0 count as equal.
  const auto takesPart = [&](double weight) { return among == EvenAmong::all || total == 0 || weight > 0; };
  const auto count = static_cast<double>(std::ranges::count_if(weights, takesPart));
  std::vector<double> shares;
  for (const double weight : weights) {
    const double own = total > 0 ? weight / total : 1 / count;
    shares.push_back(takesPart(weight) ? (1 - even) * own + even / count : 0);
  }
  return shares;
}

}  // namespace wavecrest
