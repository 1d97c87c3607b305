// Mitsuba 0.6's `coating` and `roughcoating`: a dielectric layer around another BSDF. Over a diffuse one that is
// plastic, up to how often light is reflected within the layer; over others we have nothing like it.
#include "engine/load/bsdfs.h"
#include "engine/load/color.h"
#include "engine/load/materials.h"
#include "engine/load/values.h"

namespace wavecrest {

namespace {

void readAnyCoating(LoadContext& context, Parameters& parameters, Material& material, bool rough) {
  Plastic plastic;
  plastic.intIor = parameters.ior("int_ior", "bk7");
  plastic.extIor = parameters.ior("ext_ior", "air");
  plastic.nonlinear = true;
  if (rough) {
    const std::string distribution = toLower(parameters.string("distribution", "beckmann"));
    if (distribution != "ggx" && distribution != "beckmann") {
      throw LoadError(parameters.locationOf("distribution"),
                      "unknown distribution " + inQuotes(distribution) + "; expected beckmann or ggx");
    }
    plastic.distribution = distribution == "ggx" ? Distribution::ggx : Distribution::beckmann;
    plastic.alpha.value = parameters.positiveReal("alpha", 0.1);
    parameters.ignore({"sample_visible"});
  }
  const double thickness = parameters.real("thickness", 1);
  if (const XmlElement* absorption = parameters.element("sigma_a")) {
    const Rgb sigma = readColor(context, *absorption, ColorRole::unbounded);
    if (thickness != 0 && sigma != Rgb{0, 0, 0}) {
      context.note(parameters.locationOf("sigma_a"),
                   "absorption of a " + std::string(rough ? "roughcoating" : "coating"), "left out");
    }
  }
  readBsdf(context, parameters.onlyObject("bsdf"), material);  // which may also be two-sided or have a map
  // After the base's reflectance, as that of plastic: textures are numbered as they are read.
  plastic.specularReflectance = readTexturedRgb(context, parameters, "specular_reflectance", 1);
  const auto* diffuse = std::get_if<Diffuse>(&material.kind);
  if (diffuse == nullptr || material.opacity) {
    context.unsupported(parameters.location(),
                        parameters.describe() + " around another BSDF than diffuse is not supported; expected diffuse");
    return;  // without its coat
  }
  plastic.diffuseReflectance = diffuse->reflectance;
  context.note(parameters.location(), parameters.describe() + " around diffuse",
               std::string(rough ? "roughplastic" : "plastic") +
                   ", which also has what the coat reflects back onto the base more than once");
  material.kind = plastic;
}

}  // namespace

void readCoating(LoadContext& context, Parameters& parameters, Material& material) {
  readAnyCoating(context, parameters, material, false);
}
void readRoughCoating(LoadContext& context, Parameters& parameters, Material& material) {
  readAnyCoating(context, parameters, material, true);
}

}  // namespace wavecrest
