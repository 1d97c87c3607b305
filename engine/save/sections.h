// The parts of a scene file in the order in which they are written, and what they share.
#pragma once

#include <pugixml.hpp>
#include <string>
#include <vector>

#include "engine/save/asset_files.h"
#include "engine/save/xml_nodes.h"

namespace wavecrest {

struct SaveContext {
  const Scene& scene;
  pugi::xml_node root;
  AssetFiles& assets;
  std::vector<Note>& notes;
  XmlNames names;

  // By index in the scene; empty: nothing refers to it. Filled by saveTextures and saveMaterials.
  std::vector<std::string> textureIds{}, materialIds{};
  // For each shape of the scene: the bitmap that the loader made of an attribute of the shape's mesh, if its PLY file
  // is to have that attribute; else null. Filled by saveTextures.
  std::vector<const Bitmap*> meshAttributes{};
  // For each texture of numbers that the loader derived from a colour texture: the index of that one, which a file
  // refers to instead; else kNone.
  std::vector<uint32_t> scalarSources{};
};

void saveIntegrator(SaveContext& context);
void saveSensor(SaveContext& context);  // with film and sampler
void saveTextures(SaveContext& context);
void saveMaterials(SaveContext& context);
void saveShapes(SaveContext& context);  // with their area lights
void saveEmitters(SaveContext& context);

// A parameter that is constant or textured.
void addTexturedRgb(const SaveContext& context, pugi::xml_node node, const char* name, const TexturedRgb& value);
void addTexturedFloat(const SaveContext& context, pugi::xml_node node, const char* name, const TexturedFloat& value);

}  // namespace wavecrest
