#include <algorithm>

#include "engine/save/sections.h"

namespace wavecrest {

namespace {

constexpr Rgb kWhite{1, 1, 1};

// Whether the plugin is the rough one. The loader keeps roughness of rough plugins above 0.
bool isRough(const TexturedFloat& alpha) { return alpha.texture != kNone || alpha.value != 0; }

// Writes a BSDF without its adapters below `parent`.
class BsdfWriter {
 public:
  BsdfWriter(SaveContext& context, const Material& material, pugi::xml_node parent, const std::string& id)
      : context_(context), material_(material), parent_(parent), id_(id) {}

  void operator()(const Diffuse& m) {
    start("diffuse");
    reflectance("reflectance", m.reflectance);
  }
  void operator()(const Conductor& m) {
    start(isRough(m.alpha) ? "roughconductor" : "conductor");
    // The material "none" stands for these numbers.
    if (m.perfectMirror && m.eta == Rgb{0, 0, 0} && m.k == kWhite) {
      addString(node_, "material", "none");
    } else {
      addRgb(node_, "eta", m.eta);
      addRgb(node_, "k", m.k);
    }
    roughness(m.alpha, m.alphaV, m.distribution);
    factor("specular_reflectance", m.specularReflectance);
  }
  void operator()(const Dielectric& m) {
    start(m.thin ? "thindielectric" : isRough(m.alpha) ? "roughdielectric" : "dielectric");
    indices(m.intIor, m.extIor);
    roughness(m.alpha, m.alphaV, m.distribution);
    factor("specular_reflectance", m.specularReflectance);
    factor("specular_transmittance", m.specularTransmittance);
  }
  void operator()(const Plastic& m) {
    start(isRough(m.alpha) ? "roughplastic" : "plastic");
    indices(m.intIor, m.extIor);
    roughness(m.alpha, {}, m.distribution);
    reflectance("diffuse_reflectance", m.diffuseReflectance);
    factor("specular_reflectance", m.specularReflectance);
    if (m.nonlinear) addBoolean(node_, "nonlinear", true);
  }
  void operator()(const Principled& m) {
    start(m.thin ? "principledthin" : "principled");
    reflectance("base_color", m.baseColor);
    addFloat(node_, "eta", m.eta);
    addTexturedFloat(context_, node_, "roughness", m.roughness);
    number("anisotropic", m.anisotropic);
    number("spec_trans", m.specTrans);
    number("spec_tint", m.specTint);
    number("sheen", m.sheen);
    number("sheen_tint", m.sheenTint);
    number("flatness", m.flatness);
    number("metallic", m.metallic);
    number("clearcoat", m.clearcoat);
    number("clearcoat_gloss", m.clearcoatGloss);
    number("diff_trans", m.diffTrans);
  }
  void operator()(const Blend& m) {
    start("blendbsdf");
    if (m.weightTexture != kNone) {
      addTexturedFloat(context_, node_, "weight", {.value = 0, .texture = m.weightTexture});
      for (const uint32_t part : m.materials) addRef(node_, context_.materialIds[part]);
      return;
    }
    // `weight` is that of the second BSDF. The second is what all other parts make together.
    addFloat(node_, "weight", 1 - m.weights[0]);
    addRef(node_, context_.materialIds[m.materials[0]]);
    if (m.materials.size() > 1) return parts(m, 1, 1 - m.weights[0]);
    // A single part is blended with black, which takes the rest.
    addRgb(addObject(node_, "bsdf", "diffuse", ""), "reflectance", {0, 0, 0});
  }
  void operator()(const Phong& m) {
    start("phong");
    reflectance("diffuse_reflectance", m.diffuseReflectance);
    reflectance("specular_reflectance", m.specularReflectance);
    addFloat(node_, "exponent", m.exponent);
    context_.notes.push_back({material_.source, "bsdf \"phong\"", "written as it is, which Mitsuba 3 does not know"});
  }

 private:
  void start(const char* type) { node_ = addObject(parent_, "bsdf", type, id_); }
  // A colour, which may be above 1, or a texture, by name.
  void reflectance(const char* name, const TexturedRgb& value) {
    if (value.texture == kNone && std::ranges::max(value.value) > 1) return addUnbounded(node_, name, value.value);
    addTexturedRgb(context_, node_, name, value);
  }
  // A factor that is 1 unless a file says otherwise, in [0, 1] or not.
  void factor(const char* name, const TexturedRgb& value) {
    if (value.texture != kNone || value.value != kWhite) reflectance(name, value);
  }
  void indices(double interior, double exterior) {
    addFloat(node_, "int_ior", interior);
    addFloat(node_, "ext_ior", exterior);
  }
  // Distribution and roughness of a rough plugin; nothing for a smooth one.
  void roughness(const TexturedFloat& alpha, const std::optional<TexturedFloat>& alphaV, Distribution distribution) {
    if (!isRough(alpha) && !alphaV) return;
    addString(node_, "distribution", distribution == Distribution::ggx ? "ggx" : "beckmann");
    addTexturedFloat(context_, node_, alphaV ? "alpha_u" : "alpha", alpha);
    if (alphaV) addTexturedFloat(context_, node_, "alpha_v", *alphaV);
  }
  // A number that is 0 unless a file says otherwise.
  void number(const char* name, const TexturedFloat& value) {
    if (value.texture != kNone || value.value != 0) addTexturedFloat(context_, node_, name, value);
  }
  // Writes the parts [first, ...) of a blend as blends of two within each other. `rest` is the weight that all of them
  // share, black included.
  void parts(const Blend& blend, size_t first, double rest) {
    // The share of this part in the rest.
    const double weight = rest > 0 ? std::min(blend.weights[first] / rest, 1.0) : 1;
    const bool last = first + 1 == blend.materials.size();
    if (last && weight > 1 - 1e-9) return addRef(node_, context_.materialIds[blend.materials[first]]);
    node_ = addObject(node_, "bsdf", "blendbsdf", "");
    addFloat(node_, "weight", 1 - weight);
    addRef(node_, context_.materialIds[blend.materials[first]]);
    if (!last) return parts(blend, first + 1, rest - blend.weights[first]);
    addRgb(addObject(node_, "bsdf", "diffuse", ""), "reflectance", {0, 0, 0});  // weights that are less than 1 together
  }

  SaveContext& context_;
  const Material& material_;
  pugi::xml_node parent_, node_;
  const std::string& id_;
};

// Opens the adapters around a material's BSDF, the outermost with the material's id.
class AdapterWriter {
 public:
  AdapterWriter(SaveContext& context, const Material& material, std::string id)
      : context_(context), material_(material), parent_(context.root), id_(std::move(id)) {}

  // Adapters from the outermost to the innermost, then the BSDF.
  void write() {
    const bool mapOutside = material_.normalMapping.aroundTwoSided || !material_.twoSided;
    if (mapOutside && mapBeforeMask()) map();
    mask();
    if (mapOutside && !mapBeforeMask()) map();
    if (material_.twoSided) open("twosided");
    if (!mapOutside) map();
    std::visit(BsdfWriter(context_, material_, parent_, id_), material_.kind);
  }

 private:
  // Adds an adapter within those before. The first element gets the id.
  pugi::xml_node open(const char* type) {
    parent_ = addObject(parent_, "bsdf", type, id_);
    id_.clear();
    return parent_;
  }
  // Either order is the same material. Textures are numbered as they are read, so the first one is outside.
  bool mapBeforeMask() const {
    const uint32_t map = std::min(material_.bumpTexture, material_.normalTexture);  // kNone is above all
    return material_.opacity && material_.opacity->texture != kNone && map < material_.opacity->texture;
  }
  void mask() {
    if (material_.opacity) addTexturedFloat(context_, open("mask"), "opacity", *material_.opacity);
  }
  // A bump or normal map; a material has at most one of them.
  void map() {
    if (material_.bumpTexture != kNone) {
      const pugi::xml_node node = open("bumpmap");
      addTexturedFloat(context_, node, "map", {.value = 0, .texture = material_.bumpTexture});
      addFloat(node, "scale", material_.bumpScale);
      addMapping(node);
    } else if (material_.normalTexture != kNone) {
      const pugi::xml_node node = open("normalmap");
      addTexturedRgb(context_, node, "normalmap", {.value = {}, .texture = material_.normalTexture});
      addMapping(node);
    }
  }
  void addMapping(pugi::xml_node node) const {
    if (!material_.normalMapping.flipInvalidNormals) addBoolean(node, "flip_invalid_normals", false);
    if (!material_.normalMapping.shadowing) addBoolean(node, "use_shadowing_function", false);
  }

  SaveContext& context_;
  const Material& material_;
  pugi::xml_node parent_;
  std::string id_;
};

}  // namespace

void saveMaterials(SaveContext& context) {
  for (const Material& material : context.scene.materials) {
    const std::string fallback = "material-" + std::to_string(context.materialIds.size() + 1);
    context.materialIds.push_back(context.names.unique(material.id, fallback));
    AdapterWriter(context, material, context.materialIds.back()).write();
  }
}

}  // namespace wavecrest
