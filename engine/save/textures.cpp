#include <algorithm>
#include <set>

#include "engine/load/materials.h"
#include "engine/save/sections.h"

namespace wavecrest {

namespace {

// The textures that are asked for, as colours, as numbers and as normal maps.
struct TextureUses {
  std::set<uint32_t> colors, numbers, normals;

  void operator()(const TexturedRgb& value) { add(colors, value.texture); }
  void operator()(const TexturedFloat& value) { add(numbers, value.texture); }
  void operator()(const Diffuse& m) { (*this)(m.reflectance); }
  void operator()(const Conductor& m) {
    (*this)(m.specularReflectance);
    (*this)(m.alpha);
    if (m.alphaV) (*this)(*m.alphaV);
  }
  void operator()(const Dielectric& m) {
    (*this)(m.specularReflectance);
    (*this)(m.specularTransmittance);
    (*this)(m.alpha);
    if (m.alphaV) (*this)(*m.alphaV);
  }
  void operator()(const Plastic& m) {
    (*this)(m.diffuseReflectance);
    (*this)(m.specularReflectance);
    (*this)(m.alpha);
  }
  void operator()(const Phong& m) {
    (*this)(m.diffuseReflectance);
    (*this)(m.specularReflectance);
  }
  void operator()(const Principled& m) {
    (*this)(m.baseColor);
    for (const TexturedFloat* value : {&m.roughness, &m.anisotropic, &m.specTrans, &m.specTint, &m.sheen, &m.sheenTint,
                                       &m.flatness, &m.metallic, &m.clearcoat, &m.clearcoatGloss, &m.diffTrans}) {
      (*this)(*value);
    }
  }
  // Its parts are materials of the scene as well.
  void operator()(const Blend& m) { add(numbers, m.weightTexture); }
  void operator()(const Material& m) {
    std::visit(*this, m.kind);
    if (m.opacity) (*this)(*m.opacity);
    add(numbers, m.bumpTexture);
    add(normals, m.normalTexture);
  }

  static void add(std::set<uint32_t>& uses, uint32_t texture) {
    if (texture != kNone) uses.insert(texture);
  }
};

// The uses by all materials and lights.
TextureUses usesOf(const Scene& scene) {
  TextureUses uses;
  for (const Material& material : scene.materials) uses(material);
  for (const Emitter& emitter : scene.emitters) {
    if (const auto* area = std::get_if<AreaEmitter>(&emitter.kind)) uses(area->radiance);
    if (const auto* spot = std::get_if<SpotEmitter>(&emitter.kind)) TextureUses::add(uses.colors, spot->texture);
    if (const auto* projector = std::get_if<ProjectorEmitter>(&emitter.kind)) uses(projector->irradiance);
  }
  return uses;
}

// Whether two textures have the same values everywhere; bitmaps may be different objects.
bool isSame(const Texture& a, const Texture& b) {
  if (a.kind.index() != b.kind.index() || a.toUv != b.toUv) return false;
  if (const auto* board = std::get_if<CheckerboardTexture>(&a.kind)) {
    const auto& other = std::get<CheckerboardTexture>(b.kind);
    return board->color0 == other.color0 && board->color1 == other.color1;
  }
  const auto &image = std::get<BitmapTexture>(a.kind), &other = std::get<BitmapTexture>(b.kind);
  const Bitmap &p = *image.bitmap, &q = *other.bitmap;
  return image.filter == other.filter && image.wrap == other.wrap && p.width == q.width && p.height == q.height &&
         p.channels == q.channels && p.pixels == q.pixels;
}

// Whether scalarTexture could make `scalar` of a texture: a quick test before the exact one.
bool mayBeSource(const Texture& texture, const Texture& scalar) {
  const auto *a = std::get_if<BitmapTexture>(&texture.kind), *b = std::get_if<BitmapTexture>(&scalar.kind);
  if (a == nullptr || b == nullptr) return a == nullptr && b == nullptr;
  return a->bitmap->channels == 3 && a->bitmap->width == b->bitmap->width && a->bitmap->height == b->bitmap->height;
}

// For each texture of numbers, the colour texture from which the loader derives it in a file of version 3, or kNone.
// The loader puts both into the scene, the derived one behind its source. A file has only the source. Each source has
// one derived texture.
std::vector<uint32_t> findScalarSources(const Scene& scene, const std::set<uint32_t>& numbers) {
  std::vector<uint32_t> sources(scene.textures.size(), kNone);
  std::set<uint32_t> taken;
  for (const uint32_t scalar : numbers) {
    for (uint32_t i = 0; i < scalar && sources[scalar] == kNone; ++i) {
      const Texture& texture = scene.textures[i];
      if (taken.contains(i) || !mayBeSource(texture, scene.textures[scalar])) continue;
      if (isSame(scalarTexture(texture, true), scene.textures[scalar])) sources[scalar] = i;
    }
    taken.insert(sources[scalar]);
  }
  return sources;
}

// The bitmap of a mesh attribute, if all textures of a shape are made of it; else null.
const Bitmap* attributeOf(const SaveContext& context, const Shape& shape) {
  TextureUses uses;
  if (shape.material != kNone) {
    const Material& material = context.scene.materials[shape.material];
    uses(material);
    if (const auto* blend = std::get_if<Blend>(&material.kind)) {
      for (const uint32_t part : blend->materials) uses(context.scene.materials[part]);
    }
  }
  if (shape.emitter != kNone) uses(std::get<AreaEmitter>(context.scene.emitters[shape.emitter].kind).radiance);
  // The textures that the file refers to.
  std::set<uint32_t> all = std::move(uses.colors);
  all.merge(uses.normals);
  for (const uint32_t number : uses.numbers) {
    const uint32_t source = context.scalarSources[number];
    all.insert(source != kNone ? source : number);
  }
  // All of them must be the same attribute.
  const Bitmap* found = nullptr;
  for (const uint32_t index : all) {
    const auto* texture = std::get_if<BitmapTexture>(&context.scene.textures[index].kind);
    if (texture == nullptr || texture->attribute == nullptr) return nullptr;
    if (found != nullptr && found != texture->attribute.get()) return nullptr;
    found = texture->attribute.get();
  }
  return found;
}

// Writes what a bitmap texture has to say about its file and its lookup.
void saveBitmap(SaveContext& context, const BitmapTexture& texture, bool isData, pugi::xml_node node) {
  const StoredBitmap stored = context.assets.addBitmap(texture.bitmap, isData);
  addString(node, "filename", stored.filename);
  if (stored.raw) addBoolean(node, "raw", true);
  if (texture.filter == Filter::nearest) addString(node, "filter_type", "nearest");
  if (texture.wrap == Wrap::mirror) addString(node, "wrap_mode", "mirror");
  if (texture.wrap == Wrap::clamp) addString(node, "wrap_mode", "clamp");
}

// A colour of a checkerboard. Mitsuba takes no <rgb> above 1: equal channels are a number then, others a spectrum.
void addSquare(pugi::xml_node node, const char* name, const Rgb& color) {
  if (std::ranges::max(color) <= 1) return addRgb(node, name, color);
  if (color[0] == color[1] && color[0] == color[2]) return addFloat(node, name, color[0]);
  addUnbounded(node, name, color);
}

// Writes one texture. isNumber: it is asked for as a number, and has no source. isData: it is not asked for as a
// colour.
void saveTexture(SaveContext& context, const Texture& texture, bool isNumber, bool isData, const std::string& id) {
  const auto* bitmap = std::get_if<BitmapTexture>(&texture.kind);
  const auto& attributes = context.meshAttributes;
  if (bitmap != nullptr && bitmap->attribute != nullptr &&
      std::ranges::find(attributes, bitmap->attribute.get()) != attributes.end()) {
    const pugi::xml_node attribute = addObject(context.root, "texture", "mesh_attribute", id);
    // The name follows from the number of channels.
    addString(attribute, "name", unbakedAttribute(*bitmap->attribute, 0).name);
    if (bitmap->attributeScale != 1) addFloat(attribute, "scale", bitmap->attributeScale);
    return;
  }
  pugi::xml_node node = addObject(context.root, "texture", bitmap != nullptr ? "bitmap" : "checkerboard", id);
  if (bitmap != nullptr) {
    saveBitmap(context, *bitmap, isData, node);
  } else {
    // The loader exchanges the colours of a checkerboard that is asked for a number (scalarTexture).
    const auto& board = std::get<CheckerboardTexture>(texture.kind);
    addSquare(node, "color0", isNumber ? board.color1 : board.color0);
    addSquare(node, "color1", isNumber ? board.color0 : board.color1);
  }
  addTransform(node, "to_uv", texture.toUv);
}

}  // namespace

void saveTextures(SaveContext& context) {
  const Scene& scene = context.scene;
  // Which textures the file has: first what refers to them, then which are derived or made of attributes.
  const TextureUses uses = usesOf(scene);
  context.textureIds.assign(scene.textures.size(), "");
  context.scalarSources = findScalarSources(scene, uses.numbers);
  for (const Shape& shape : scene.shapes) context.meshAttributes.push_back(attributeOf(context, shape));
  // The sources of textures of numbers.
  std::set<uint32_t> sources;
  for (const uint32_t scalar : uses.numbers) TextureUses::add(sources, context.scalarSources[scalar]);
  // Write those that are used, in the scene's order.
  for (uint32_t i = 0; i < scene.textures.size(); ++i) {
    const bool isColor = uses.colors.contains(i), isSource = sources.contains(i), isNormal = uses.normals.contains(i);
    const bool isNumber = uses.numbers.contains(i) && context.scalarSources[i] == kNone;
    if (!isColor && !isSource && !isNormal && !isNumber) continue;
    context.textureIds[i] = context.names.unique("", "texture-" + std::to_string(i + 1));
    saveTexture(context, scene.textures[i], isNumber, !isColor, context.textureIds[i]);
  }
}

void addTexturedRgb(const SaveContext& context, pugi::xml_node node, const char* name, const TexturedRgb& value) {
  if (value.texture != kNone) return addRef(node, context.textureIds[value.texture], name);
  addRgb(node, name, value.value);
}

void addTexturedFloat(const SaveContext& context, pugi::xml_node node, const char* name, const TexturedFloat& value) {
  if (value.texture == kNone) return addFloat(node, name, value.value);
  const uint32_t source = context.scalarSources[value.texture];
  addRef(node, context.textureIds[source != kNone ? source : value.texture], name);
}

}  // namespace wavecrest
