#include "engine/load/mesh_attributes.h"

#include <algorithm>
#include <cmath>

#include "engine/load/values.h"

namespace wavecrest {

namespace {

// Finds the mesh attribute that the materials and the light of a shape use. Visits each object once.
class AttributeSearch {
 public:
  explicit AttributeSearch(const LoadContext& context) : context_(context) {}

  // In the order of the file. A list in place of recursion: chains of references can be too long for the stack.
  void visit(const XmlElement& shape) {
    std::vector<const XmlElement*> waiting{&shape};
    while (!waiting.empty()) {
      const XmlElement& element = context_.resolve(*waiting.back());
      waiting.pop_back();
      if (!visited_.insert(&element).second) continue;
      if (element.tag == "texture" && element.get("type") == "mesh_attribute") {
        add(element);
      } else if (element.tag == "texture" && !otherTexture_ && element.get("type") != "rawconstant") {
        // Every other texture than a rawconstant needs the texture coordinates of the file.
        otherTexture_ = &element;
      }
      for (auto child = element.children.rbegin(); child != element.children.rend(); ++child) {
        // Follow only what may contain or refer to a texture of the shape.
        const bool belongs =
            child->tag == "ref" || child->tag == "bsdf" || child->tag == "texture" || child->tag == "emitter";
        if (belongs) waiting.push_back(&*child);
      }
    }
  }
  // The name of the attribute; empty if there is none. LoadError if the shape has another texture too: baking replaces
  // the texture coordinates of the mesh.
  std::string found() const {
    if (!name_.empty() && otherTexture_) {
      throw LoadError(otherTexture_->location(), "texture " + inQuotes(otherTexture_->get("type")) +
                                                     " beside a mesh_attribute on one shape is not supported; expected "
                                                     "only one of the two");
    }
    return name_;
  }

 private:
  // Takes the name from a mesh_attribute texture. LoadError if the shape has an attribute of another name.
  void add(const XmlElement& texture) {
    for (const XmlElement& child : texture.children) {
      if (child.get("name") != "name") continue;
      const std::string name(child.get("value"));
      if (!name_.empty() && name != name_) {
        throw LoadError(texture.location(), "attributes " + inQuotes(name_) + " and " + inQuotes(name) +
                                                " on one shape are not supported; expected one attribute");
      }
      name_ = name;
    }
  }

  const LoadContext& context_;
  std::set<const XmlElement*> visited_;
  const XmlElement* otherTexture_ = nullptr;
  std::string name_;
};

}  // namespace

std::vector<AttributeFields> MeshAttribute::possibleFields() const {
  const size_t underscore = name.find('_');
  if (underscore == std::string::npos) return {};
  const std::string own = name.substr(underscore + 1);
  const auto withEnds = [](const std::string& prefix, const char* ends) {
    return AttributeFields{prefix + "_" + ends[0], prefix + "_" + ends[1], prefix + "_" + ends[2]};
  };
  // NAME_0 and so on. The attribute NAME_color has the properties NAME_r, NAME_g and NAME_b.
  std::vector<AttributeFields> possible;
  for (const char* ends : {"012", "xyz", "123"}) possible.push_back(withEnds(own, ends));
  constexpr std::string_view kColor = "_color";
  if (own.ends_with(kColor)) possible.push_back(withEnds(own.substr(0, own.size() - kColor.size()), "rgb"));
  // The attribute "color" alone has names without an underscore.
  if (own == "color") {
    possible.push_back({"r", "g", "b"});
    possible.push_back({"red", "green", "blue"});
  }
  return possible;
}

int MeshAttribute::channelOf(std::string_view property) const {
  const auto field = std::ranges::find(fields, property);
  return field == fields.end() ? -1 : static_cast<int>(field - fields.begin());
}

std::string meshAttributeOf(LoadContext& context, const XmlElement& shape) {
  AttributeSearch search(context);
  search.visit(shape);
  return search.found();
}

std::shared_ptr<const Bitmap> bakeMeshAttribute(const MeshAttribute& attribute, Mesh& mesh) {
  // Arrange the cells, one for each triangle, in a grid that is about square.
  const size_t count = mesh.triangles.size();
  const auto columns = static_cast<size_t>(std::ceil(std::sqrt(static_cast<double>(std::max<size_t>(count, 1)))));
  const size_t rows = std::max<size_t>(1, (count + columns - 1) / columns), channels = attribute.channels;
  auto bitmap = std::make_shared<Bitmap>(Bitmap{.width = static_cast<uint32_t>(2 * columns),
                                                .height = static_cast<uint32_t>(2 * rows),
                                                .channels = static_cast<uint32_t>(channels),
                                                .pixels = std::vector<float>(4 * columns * rows * channels)});
  // Fill the cells, and give each triangle three vertices of its own.
  Mesh split;
  for (size_t i = 0; i < count; ++i) {
    const std::array<uint32_t, 3> corners = mesh.triangles[i];
    // The top left texel of the cell.
    const size_t x = 2 * (i % columns), y = 2 * (i / columns);
    for (size_t c = 0; c < channels; ++c) {
      const auto valueAt = [&](size_t k) {
        return attribute.values[(attribute.perFace() ? i : corners[k]) * channels + c];
      };
      const auto texel = [&](size_t dx, size_t dy) -> float& {
        return bitmap->pixels[((y + dy) * 2 * columns + x + dx) * channels + c];
      };
      texel(0, 0) = valueAt(0);
      texel(1, 0) = valueAt(1);
      texel(0, 1) = valueAt(2);
      texel(1, 1) = valueAt(1) + valueAt(2) - valueAt(0);
    }
    // The corners have the centres of the texels (0, 0), (1, 0) and (0, 1) as texture coordinates.
    for (size_t k = 0; k < 3; ++k) {
      split.positions.push_back(mesh.positions[corners[k]]);
      if (!mesh.normals.empty()) split.normals.push_back(mesh.normals[corners[k]]);
      const double u = static_cast<double>(x) + (k == 1 ? 1.5 : 0.5), v = static_cast<double>(y) + (k == 2 ? 1.5 : 0.5);
      split.uvs.push_back({static_cast<float>(u / static_cast<double>(2 * columns)),
                           static_cast<float>(v / static_cast<double>(2 * rows))});
    }
    const auto first = static_cast<uint32_t>(3 * i);
    split.triangles.push_back({first, first + 1, first + 2});
  }
  mesh = std::move(split);
  return bitmap;
}

MeshAttribute unbakedAttribute(const Bitmap& bitmap, size_t triangles) {
  const size_t channels = bitmap.channels, columns = bitmap.width / 2;
  MeshAttribute attribute{.name = channels == 3 ? "vertex_color" : "vertex_value", .channels = channels, .values = {}};
  attribute.values.reserve(3 * triangles * channels);
  for (size_t i = 0; i < triangles; ++i) {
    // The top left texel of the cell, its right and its lower neighbour hold the values of the corners.
    const size_t corner = (2 * (i / columns) * bitmap.width + 2 * (i % columns));
    for (const size_t texel : {corner, corner + 1, corner + bitmap.width}) {
      const auto value = bitmap.pixels.begin() + static_cast<ptrdiff_t>(texel * channels);
      attribute.values.insert(attribute.values.end(), value, value + static_cast<ptrdiff_t>(channels));
    }
  }
  return attribute;
}

Texture readMeshAttribute(LoadContext& context, Parameters& parameters) {
  const std::string name = parameters.requiredString("name");
  const double scale = parameters.real("scale", 1);
  if (!name.starts_with("vertex_") && !name.starts_with("face_")) {
    throw LoadError(parameters.locationOf("name"),
                    "attribute " + inQuotes(name) + " of a mesh; expected a name that starts with vertex_ or face_");
  }
  BitmapTexture texture{.bitmap = context.attributeBitmap,
                        .filter = Filter::bilinear,
                        .wrap = Wrap::clamp,
                        .attribute = context.attributeBitmap,
                        .attributeScale = scale};
  if (texture.attribute == nullptr) {
    // Outside of a mesh there is no attribute, and the texture is black.
    texture.bitmap = std::make_shared<Bitmap>(Bitmap{.width = 1, .height = 1, .channels = 3, .pixels = {0, 0, 0}});
  } else if (scale != 1) {
    auto scaled = std::make_shared<Bitmap>(*texture.attribute);
    for (float& value : scaled->pixels) value = static_cast<float>(scale * value);
    texture.bitmap = std::move(scaled);
  }
  return {.kind = std::move(texture), .toUv = identityMatrix()};
}

}  // namespace wavecrest
