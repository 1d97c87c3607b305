#include "engine/load/scene_hash.h"

#include <bit>

namespace wavecrest {

namespace {

// Words are folded in one at a time: xor, multiply by a large odd constant, fold the high half down. The finalizer of
// splitmix64 (Steele, Lea and Flood 2014) makes the last words count as much as the first.
class Hasher {
 public:
  void word(uint64_t w) {
    state_ = (state_ ^ w) * 0x9e3779b97f4a7c15u;
    state_ ^= state_ >> 32;
  }
  template <class T>
  void operator()(const T& value) {
    add(value);
  }
  // The hash of all words so far.
  uint64_t value() const {
    uint64_t x = state_;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
  }

  template <class... T>
  void all(const T&... values) {
    (add(values), ...);
  }

 private:
  // Numbers enter by their bits, so 0 and -0 have different hashes.
  void add(double v) { word(std::bit_cast<uint64_t>(v)); }
  void add(float v) { word(std::bit_cast<uint32_t>(v)); }
  void add(uint32_t v) { word(v); }
  void add(uint64_t v) { word(v); }
  void add(int v) { word(static_cast<uint64_t>(static_cast<int64_t>(v))); }
  void add(bool v) { word(v ? 1 : 0); }
  template <class E>
  requires std::is_enum_v<E>
  void add(E e) { word(static_cast<uint64_t>(e)); }
  template <class T, size_t N>
  void add(const std::array<T, N>& values) {
    for (const T& v : values) add(v);
  }
  // Containers enter their size or kind first, so that different structures do not give the same words.
  template <class T>
  void add(const std::vector<T>& values) {
    word(values.size());
    for (const T& v : values) add(v);
  }
  template <class T>
  void add(const std::optional<T>& v) {
    add(v.has_value());
    if (v) add(*v);
  }
  template <class... T>
  void add(const std::variant<T...>& v) {
    word(v.index());
    std::visit([this](const auto& alternative) { add(alternative); }, v);
  }

  // Textures. A bitmap enters by its pixels, whatever file they are from.
  void add(const Bitmap& b) { all(b.width, b.height, b.channels, b.pixels); }
  void add(const BitmapTexture& t) { all(*t.bitmap, t.filter, t.wrap); }
  void add(const CheckerboardTexture& t) { all(t.color0, t.color1); }
  void add(const Texture& t) { all(t.kind, t.toUv); }
  void add(const TexturedRgb& t) { all(t.value, t.texture); }
  void add(const TexturedFloat& t) { all(t.value, t.texture); }

  // Materials.
  void add(const Diffuse& m) { all(m.reflectance); }
  void add(const Conductor& m) {
    all(m.eta, m.k, m.perfectMirror, m.specularReflectance, m.alpha, m.distribution);
    if (m.alphaV) add(*m.alphaV);
  }
  void add(const Dielectric& m) {
    all(m.intIor, m.extIor, m.specularReflectance, m.specularTransmittance, m.alpha, m.thin, m.distribution);
    if (m.alphaV) add(*m.alphaV);
  }
  void add(const Plastic& m) {
    all(m.intIor, m.extIor, m.diffuseReflectance, m.specularReflectance, m.alpha, m.nonlinear, m.distribution);
  }
  void add(const Phong& m) { all(m.diffuseReflectance, m.specularReflectance, m.exponent); }
  void add(const Principled& m) {
    all(m.thin, m.baseColor, m.eta, m.roughness, m.anisotropic, m.specTrans, m.specTint, m.sheen, m.sheenTint,
        m.flatness, m.metallic, m.clearcoat, m.clearcoatGloss, m.diffTrans);
  }
  // Weights as kernels have them: a file may give them in another way, with other last digits.
  void add(const Blend& m) {
    all(m.materials, std::vector<float>(m.weights.begin(), m.weights.end()), m.weightTexture);
  }
  void add(const NormalMapping& m) { all(m.flipInvalidNormals, m.shadowing, m.aroundTwoSided); }
  // How a map is applied has no effect without a map.
  void add(const Material& m) {
    all(m.kind, m.twoSided, m.opacity, m.bumpTexture, m.bumpScale, m.normalTexture);
    if (m.hasMap()) add(m.normalMapping);
  }

  // Shapes. hashScene adds the groups.
  void add(const Mesh& s) { all(s.positions, s.normals, s.uvs, s.triangles); }
  void add(const Rectangle& s) { all(s.corner, s.edgeU, s.edgeV, s.mirrored); }
  void add(const Disk& s) { all(s.center, s.axisU, s.axisV, s.mirrored); }
  void add(const Sphere& s) { all(s.center, s.radius, s.flipNormals, s.toWorld); }
  void add(const Cylinder& s) { all(s.p0, s.p1, s.radius, s.flipNormals, s.phi0, s.phi90); }
  void add(const Shape& s) { all(s.kind, s.material, s.emitter); }

  // Lights.
  void add(const AreaEmitter& e) { all(e.radiance, e.shape); }
  void add(const PointEmitter& e) { all(e.position, e.intensity); }
  void add(const SpotEmitter& e) {
    all(e.position, e.direction, e.intensity, e.cutoffAngle, e.beamWidth, e.texture, e.toWorld);
  }
  void add(const DirectionalEmitter& e) { all(e.direction, e.irradiance); }
  void add(const ConstantEmitter& e) { all(e.radiance); }
  void add(const ProjectorEmitter& e) { all(e.irradiance, e.scale, e.fovX, e.aspect, e.toWorld); }
  void add(const SunskyEmitter& e) {
    all(e.turbidity, e.albedo, e.sunDirection, e.sunScale, e.skyScale, e.sunAperture, e.toWorld);
  }
  void add(const EnvmapEmitter& e) { all(*e.bitmap, e.scale, e.toWorld); }
  void add(const Emitter& e) { all(e.kind); }

  // Camera, film, and what the file asks of the renderer.
  void add(const Sensor& s) {
    all(s.kind, s.toWorld, s.fovX, s.nearClip, s.farClip, s.apertureRadius, s.focusDistance, s.principalPointOffset);
  }
  void add(const FilmSettings& f) {
    all(f.width, f.height, f.cropX, f.cropY, f.cropWidth, f.cropHeight, f.filter, f.filterRadius, f.gaussianStddev);
  }
  void add(const RenderDefaults& d) { all(d.maxDepth, d.rrDepth, d.sampleCount, d.hideEmitters); }

  uint64_t state_ = 0x243f6a8885a308d3u;  // fractional digits of pi
};

}  // namespace

uint64_t hashScene(const Scene& scene) {
  Hasher hasher;
  hasher.all(scene.textures, scene.materials, scene.shapes, scene.emitters, scene.sensor, scene.film, scene.defaults);
  // Groups change an image only through instances.
  if (!scene.instances.empty()) {
    for (const Shape& shape : scene.shapes) hasher.word(shape.group);
    for (const Instance& instance : scene.instances) hasher.all(instance.group, instance.toWorld);
  }
  return hasher.value();
}

}  // namespace wavecrest
