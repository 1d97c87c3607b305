#include <cstring>

#include "engine/load/matrix.h"
#include "engine/load/mesh_build.h"
#include "engine/load/shapes.h"
#include "engine/save/preimage.h"
#include "engine/save/sections.h"

namespace wavecrest {

namespace {

// Affine matrix with the images of the three axes and of the origin.
Matrix4 fromColumns(const Double3& x, const Double3& y, const Double3& z, const Double3& origin) {
  Matrix4 m = identityMatrix();
  for (size_t i = 0; i < 3; ++i) m[i] = {x[i], y[i], z[i], origin[i]};
  return m;
}

bool isSame(const Cylinder& a, const Cylinder& b) {
  return a.p0 == b.p0 && a.p1 == b.p1 && a.radius == b.radius && a.flipNormals == b.flipNormals && a.phi0 == b.phi0 &&
         a.phi90 == b.phi90;
}

// Whether the loader makes the normals of this mesh, to the bit, where its file has none.
bool hasSmoothNormals(const Mesh& mesh) {
  const std::vector<Float3> smooth = smoothNormals(mesh);
  return std::memcmp(smooth.data(), mesh.normals.data(), smooth.size() * sizeof(Float3)) == 0;
}

// Writes the shape's own parameters; each call returns the shape's element.
class ShapeWriter {
 public:
  ShapeWriter(SaveContext& context, pugi::xml_node parent, std::string id, const Bitmap* attribute)
      : context_(context), parent_(parent), id_(std::move(id)), attribute_(attribute) {}

  pugi::xml_node operator()(const Mesh& mesh) const {
    const pugi::xml_node node = start("ply");
    PlyContent content;
    // An attribute replaces the texture coordinates that were baked from it.
    if (attribute_ != nullptr) content.attribute = unbakedAttribute(*attribute_, mesh.triangles.size());
    // Normals are left out where the loader makes the same ones, perhaps with flip_normals.
    const bool faceted = mesh.normals.empty();
    if (!faceted && !hasSmoothNormals(mesh)) {
      Mesh turned = mesh;
      turnAround(turned);
      if (hasSmoothNormals(turned)) {
        addString(node, "filename", context_.assets.addMesh(std::move(turned), std::move(content)));
        addBoolean(node, "flip_normals", true);
        return node;
      }
      content.normals = true;
    }
    addString(node, "filename", context_.assets.addMesh(mesh, std::move(content)));
    if (faceted) addBoolean(node, "face_normals", true);
    return node;
  }

  // to_world maps [-1, 1]^2 at z = 0 to the rectangle. It never mirrors: flip_normals does.
  pugi::xml_node operator()(const Rectangle& r) const {
    const Double3 edgeU = r.mirrored ? -1 * r.edgeU : r.edgeU;
    const Double3 x = 0.5 * edgeU, y = 0.5 * r.edgeV;
    Matrix4 toWorld = fromColumns(x, y, normalized(cross(x, y)), {});
    // The corner is a rounded sum. The translation is one from which the loader makes that corner to the bit.
    for (size_t i = 0; i < 3; ++i) {
      toWorld[i][3] = sumPreimage(r.corner[i], [&](double offset) {
        Matrix4 moved = toWorld;
        moved[i][3] = offset;
        return placeRectangle(moved, r.mirrored).corner[i];
      });
    }
    return placed("rectangle", toWorld, r.mirrored);
  }

  // As a rectangle: to_world never mirrors.
  pugi::xml_node operator()(const Disk& d) const {
    const Double3 axisV = d.mirrored ? -1 * d.axisV : d.axisV;
    return placed("disk", fromColumns(d.axisU, axisV, normalized(cross(d.axisU, axisV)), d.center), d.mirrored);
  }

  // A transform that mirrors turns the normals around by itself.
  pugi::xml_node operator()(const Sphere& s) const {
    return placed("sphere", s.toWorld, s.flipNormals != (determinant3(s.toWorld) < 0));
  }

  pugi::xml_node operator()(const Cylinder& c) const {
    // Without a transform, if the loader then makes the same cylinder.
    Matrix4 toWorld = identityMatrix();
    Double3 p0 = c.p0, p1 = c.p1;
    double radius = radiusOf(c, toWorld, p0, p1);
    if (!isSame(placeCylinder(toWorld, p0, p1, radius, c.flipNormals), c)) {
      // Otherwise as the image of a cylinder from 0 to 1 on the z axis, whose phi begins at x.
      const auto unit = [](const Double3& v) { return normalized(v); };
      constexpr double kStep = 1e-9;  // small: the two may differ in length by little
      Double3 axis{};
      for (size_t i = 0; i < 3; ++i) axis[i] = sumPreimage(c.p1[i], [&](double v) { return v + c.p0[i]; });
      toWorld = fromColumns(unitPreimage(c.phi0, kStep, unit), unitPreimage(c.phi90, kStep, unit), axis, c.p0);
      p0 = {0, 0, 0};
      p1 = {0, 0, 1};
      radius = radiusOf(c, toWorld, p0, p1);
    }
    const pugi::xml_node node = placed("cylinder", toWorld, c.flipNormals);
    addPoint(node, "p0", p0);
    addPoint(node, "p1", p1);
    addFloat(node, "radius", radius);
    return node;
  }

 private:
  pugi::xml_node start(const char* type) const { return addObject(parent_, "shape", type, id_); }
  pugi::xml_node placed(const char* type, const Matrix4& toWorld, bool flipNormals) const {
    const pugi::xml_node node = start(type);
    addTransform(node, "to_world", toWorld);
    if (flipNormals) addBoolean(node, "flip_normals", true);
    return node;
  }
  // The radius from which the loader makes that of the cylinder.
  static double radiusOf(const Cylinder& c, const Matrix4& toWorld, const Double3& p0, const Double3& p1) {
    return productPreimage(c.radius, [&](double r) { return placeCylinder(toWorld, p0, p1, r, false).radius; });
  }

  SaveContext& context_;
  pugi::xml_node parent_;  // the scene or a group
  std::string id_;
  const Bitmap* attribute_;  // of the mesh, or null
};

// Writes a shape with its material and its area light.
void saveShape(SaveContext& context, pugi::xml_node parent, size_t index) {
  const Shape& shape = context.scene.shapes[index];
  const std::string id = context.names.unique(shape.id, "shape-" + std::to_string(index + 1));
  const pugi::xml_node node = std::visit(ShapeWriter(context, parent, id, context.meshAttributes[index]), shape.kind);
  if (shape.material != kNone) addRef(node, context.materialIds[shape.material], "bsdf");
  if (shape.emitter == kNone) return;
  const auto& light = std::get<AreaEmitter>(context.scene.emitters[shape.emitter].kind);
  addTexturedRgb(context, addObject(node, "emitter", "area"), "radiance", light.radiance);
}

// Groups and their instances, in an order that the loader finds again: it reads a group's shapes at the first instance.
class InstanceWriter {
 public:
  explicit InstanceWriter(SaveContext& context) : context_(context), groups_(context.scene.groups.size()) {
    for (size_t i = 0; i < groups_.size(); ++i) {
      ids_.push_back(context.names.unique(context.scene.groups[i].id, "group-" + std::to_string(i + 1)));
    }
  }
  // Writes all instances up to the first one of the group.
  void writeUpTo(uint32_t group) {
    while (!groups_[group]) writeNext();
  }
  void writeRest() {
    while (next_ < context_.scene.instances.size()) writeNext();
  }

 private:
  // The next instance, and its group before it if that is not yet written.
  void writeNext() {
    const Instance& instance = context_.scene.instances[next_++];
    if (!groups_[instance.group]) writeGroup(instance.group);
    const std::string id = context_.names.unique(instance.id, "instance-" + std::to_string(next_));
    const pugi::xml_node node = addObject(context_.root, "shape", "instance", id);
    addRef(node, ids_[instance.group]);
    addTransform(node, "to_world", instance.toWorld);
  }
  void writeGroup(uint32_t group) {
    groups_[group] = addObject(context_.root, "shape", "shapegroup", ids_[group]);
    for (size_t i = 0; i < context_.scene.shapes.size(); ++i) {
      if (context_.scene.shapes[i].group == group) saveShape(context_, groups_[group], i);
    }
  }

  SaveContext& context_;
  std::vector<pugi::xml_node> groups_;
  std::vector<std::string> ids_;
  size_t next_ = 0;
};

}  // namespace

void saveShapes(SaveContext& context) {
  InstanceWriter instances(context);
  for (size_t i = 0; i < context.scene.shapes.size(); ++i) {
    const uint32_t group = context.scene.shapes[i].group;
    if (group == kNone) {
      saveShape(context, context.root, i);
    } else {
      instances.writeUpTo(group);
    }
  }
  instances.writeRest();
}

}  // namespace wavecrest
