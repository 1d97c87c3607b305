#include "engine/load/shapes.h"

#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "engine/load/bsdfs.h"
#include "engine/load/emitters.h"
#include "engine/load/materials.h"
#include "engine/load/mesh_attributes.h"
#include "engine/load/meshes_ahead.h"
#include "engine/load/values.h"
#include "engine/scene/vector_math.h"
#include "engine/tasks/parallel_for.h"
#include "kernels/columns/parallel_ranges.h"

namespace wavecrest {

namespace {

// Parameters that only guide how Mitsuba samples.
void ignoreCommonParameters(Parameters& parameters) { parameters.ignore({"silhouette_sampling_weight"}); }

// The object of the given tag within the shape; null if there is none. LoadError if there are several.
const XmlElement* singleChild(Parameters& parameters, std::string_view tag) {
  const std::vector<const XmlElement*> found = parameters.objects(tag);
  if (found.size() > 1) {
    throw LoadError(found[1]->location(), parameters.describe() + " contains " + std::to_string(found.size()) +
                                              " objects <" + std::string(tag) + ">; expected at most 1");
  }
  return found.empty() ? nullptr : found.front();
}

// A material that reads a mesh attribute refers to the bitmap of one mesh, so other meshes cannot share it. If the
// shape has an attribute, the context has empty tables of materials and textures while this object lives, and gets its
// old tables back afterwards.
class OwnMaterials {
 public:
  explicit OwnMaterials(LoadContext& context) : context_(context.attributeBitmap ? &context : nullptr) { exchange(); }
  ~OwnMaterials() {
    exchange();
    if (context_ != nullptr) context_->attributeBitmap = nullptr;
  }
  OwnMaterials(const OwnMaterials&) = delete;
  OwnMaterials& operator=(const OwnMaterials&) = delete;

 private:
  void exchange() {
    if (context_ == nullptr) return;
    std::swap(context_->materials, materials_);
    std::swap(context_->textures, textures_);
  }

  LoadContext* context_;
  std::map<const XmlElement*, uint32_t> materials_, textures_;
};

// Adds the light of a shape. `shapeIndex` is the index that the shape will have in the scene.
void attachAreaLight(LoadContext& context, const XmlElement& element, uint32_t shapeIndex, Shape& shape) {
  context.areaLights.insert(&element);
  shape.emitter = static_cast<uint32_t>(context.scene.emitters.size());
  context.scene.emitters.push_back(
      {.kind = readAreaEmitter(context, element, shapeIndex), .source = element.location()});
}

// Whether a shape that has neither a BSDF nor a light is the boundary of a medium in a file of 0.4 to 0.6, where such a
// boundary does not change light. Reports the medium.
bool isNullBoundary(LoadContext& context, Parameters& parameters) {
  if (!parameters.object().legacy || parameters.objects("medium").empty()) return false;
  context.unsupported(parameters.location(), "<medium> in " + parameters.describe() +
                                                 ": light transport in media is not supported" +
                                                 (context.options.lenient ? " (left out; its boundary is null)" : "") +
                                                 "; expected surfaces only");
  return true;
}

// The index of a new material of BSDF `null`.
uint32_t addNullMaterial(LoadContext& context, Parameters& shape) {
  Material material;
  material.source = shape.location();
  readNull(context, shape, material);
  context.scene.materials.push_back(std::move(material));
  return static_cast<uint32_t>(context.scene.materials.size() - 1);
}

// The index of a group in the scene; at its first instance its shapes are read.
uint32_t groupOf(LoadContext& context, const XmlElement& group) {
  if (const auto known = context.groups.find(&group); known != context.groups.end()) return known->second;
  // Register the group.
  const auto index = static_cast<uint32_t>(context.scene.groups.size());
  context.groups[&group] = index;
  context.scene.groups.push_back({.id = std::string(group.get("id")), .source = group.location()});
  // Read its shapes. addShape takes the group from the context.
  Parameters members(context, group);
  const std::vector<const XmlElement*> shapes = members.objects("shape");
  members.finish();
  context.shapeGroup = index;
  context.meshesAhead->read(context, shapes);
  for (const XmlElement* shape : shapes) addShape(context, *shape);
  context.shapeGroup = kNone;
  return index;
}

// Adds an instance of a shapegroup, whose to_world must have an inverse.
void addInstance(LoadContext& context, const XmlElement& element, Parameters& parameters) {
  if (context.shapeGroup != kNone) {
    throw LoadError(parameters.location(), "instance inside a shapegroup; expected only plain shapes in a shapegroup");
  }
  const XmlElement& group = parameters.onlyObject("shape");
  if (group.get("type") != "shapegroup") {
    throw LoadError(parameters.location(),
                    "instance of a shape of type " + inQuotes(group.get("type")) + "; expected a shapegroup");
  }
  const Matrix4 toWorld = parameters.transform("to_world").value_or(identityMatrix());
  parameters.finish();
  if (!hasInverse(toWorld)) {
    context.unsupported(parameters.locationOf("to_world"),
                        "instance that is flat in some direction; expected a to_world that has an inverse");
    return;
  }
  context.scene.instances.push_back({.id = std::string(element.get("id")),
                                     .group = groupOf(context, group),
                                     .toWorld = toWorld,
                                     .source = element.location()});
}

}  // namespace

void addShape(LoadContext& context, const XmlElement& element) {
  const std::string_view type = element.get("type");
  if (type == "shapegroup" && context.shapeGroup == kNone) return;  // a definition: only its instances appear
  Parameters parameters(context, element);
  if (type == "instance") return addInstance(context, element, parameters);
  const ShapePlugin* plugin = findPlugin(context, shapePlugins(), element, "left out");
  if (!plugin) return;

  // Read the geometry. If a material or the light asks for a mesh attribute, the reader bakes it.
  const Matrix4 own = parameters.transform("to_world").value_or(identityMatrix());
  Shape shape;
  shape.id = element.get("id");
  shape.source = element.location();
  context.meshAttribute = meshAttributeOf(context, element);
  context.attributeBitmap = nullptr;
  shape.kind = plugin->read(context, parameters, own);
  if (!context.meshAttribute.empty() && !context.attributeBitmap) {
    throw LoadError(element.location(), parameters.describe() + " has no attribute " + inQuotes(context.meshAttribute) +
                                            "; expected a ply mesh with that attribute");
  }
  // Find the material and the light among the children.
  const OwnMaterials ownMaterials(context);
  const XmlElement* bsdf = singleChild(parameters, "bsdf");
  const XmlElement* light = singleChild(parameters, "emitter");
  const bool isNull = bsdf == nullptr && light == nullptr && isNullBoundary(context, parameters);
  ignoreCommonParameters(parameters);
  parameters.finish();

  // Without area there is nothing to see, and nothing that shines.
  const double area = surfaceArea(shape.kind);
  if (area == 0) {
    if (light) context.areaLights.insert(light);
    context.note(element.location(), parameters.describe() + " without area",
                 light ? "left out with its light" : "left out");
    return;
  }
  if (!std::isfinite(area)) {
    throw LoadError(element.location(), parameters.describe() + " has an infinite area; expected a finite area");
  }
  if (context.shapeGroup != kNone && light) {
    throw LoadError(light->location(), "light inside a shapegroup; expected instances without lights");
  }
  // Add the shape, with its material and its light.
  shape.material = bsdf     ? materialOf(context, *bsdf)
                   : isNull ? addNullMaterial(context, parameters)
                            : defaultMaterial(context, light != nullptr);
  if (light) attachAreaLight(context, *light, static_cast<uint32_t>(context.scene.shapes.size()), shape);
  shape.group = context.shapeGroup;
  context.scene.shapes.push_back(std::move(shape));
}

namespace {

// Surface area of each kind of shape, in the space of the shape's coordinates.
struct Area {
  double operator()(const Mesh& mesh) const {
    // Each range has a sum of its own, so that the whole does not depend on threads.
    std::vector<double> sums(rangesOf(mesh.triangles.size()));
    forEachRange(parallelFor, mesh.triangles.size(), [&](size_t begin, size_t end) {
      double& sum = sums[rangesOf(begin)];
      for (size_t i = begin; i < end; ++i) {
        const auto at = [&](size_t k) { return widened(mesh.positions[mesh.triangles[i][k]]); };
        sum += 0.5 * length(cross(at(1) - at(0), at(2) - at(0)));
      }
    });
    return std::accumulate(sums.begin(), sums.end(), 0.0);
  }
  double operator()(const Rectangle& r) const { return length(cross(r.edgeU, r.edgeV)); }
  double operator()(const Disk& d) const { return std::numbers::pi * length(cross(d.axisU, d.axisV)); }
  double operator()(const Sphere& s) const { return 4 * std::numbers::pi * s.radius * s.radius; }
  double operator()(const Cylinder& c) const { return 2 * std::numbers::pi * c.radius * length(c.p1 - c.p0); }
};

}  // namespace

double surfaceArea(const Geometry& geometry) { return std::visit(Area{}, geometry); }

}  // namespace wavecrest
