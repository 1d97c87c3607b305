// Colours of a mesh's vertices or faces (Mitsuba's texture `mesh_attribute`), baked into a bitmap of the mesh's own.
//
// Every triangle has a cell of 2 x 2 texels, and its corners have the centres of three of them as texture coordinates.
// With the fourth texel c1 + c2 - c0, bilinear interpolation in the cell is linear interpolation in the triangle: what
// kernels look up is what the attribute says, and they need not know of attributes.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "engine/load/parameters.h"

namespace wavecrest {

// Names of three properties of a mesh file.
using AttributeFields = std::array<std::string, 3>;

struct MeshAttribute {
  std::string name;  // vertex_NAME or face_NAME; empty: none is asked for
  size_t channels = 0;
  std::vector<float> values;    // of all vertices or all triangles, one after the other
  AttributeFields fields{};     // the properties of the file that are the channels; empty until they are known
  bool ofWholeNumbers = false;  // the file has integers

  bool perFace() const { return name.starts_with("face_"); }
  // What a mesh file may call the channels, the most usual names first.
  std::vector<AttributeFields> possibleFields() const;
  // The channel that is in this property; -1: none.
  int channelOf(std::string_view property) const;
};

// The attribute that the materials and the light of a shape refer to; empty if there is none.
std::string meshAttributeOf(LoadContext& context, const XmlElement& shape);

// Gives each triangle vertices of its own, with texture coordinates in the bitmap that is returned.
std::shared_ptr<const Bitmap> bakeMeshAttribute(const MeshAttribute& attribute, Mesh& mesh);

// The values of the vertices of a mesh that bakeMeshAttribute has given its texture coordinates: three for each
// triangle.
MeshAttribute unbakedAttribute(const Bitmap& bitmap, size_t triangles);

Texture readMeshAttribute(LoadContext& context, Parameters& parameters);

}  // namespace wavecrest
