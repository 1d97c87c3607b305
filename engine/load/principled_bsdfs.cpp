// The principled BSDFs. Parameters and defaults are those of the Mitsuba 3 plugin of the same name.
#include <cmath>
#include <string>

#include "engine/load/bsdfs.h"
#include "engine/load/materials.h"

namespace wavecrest {

namespace {

// A number from 0 to `most`, else a LoadError; or a texture, whose values kernels clamp to that range.
TexturedFloat readShare(LoadContext& context, Parameters& parameters, const char* name, int most = 1) {
  const TexturedFloat share = readTexturedFloat(context, parameters, name, 0);
  if (share.texture == kNone && share.value > most) {
    throw LoadError(parameters.locationOf(name),
                    std::string(name) + " is outside of its range; expected 0 to " + std::to_string(most));
  }
  return share;
}

// The parameters that `principled` and `principledthin` share.
Principled readAnyPrincipled(LoadContext& context, Parameters& parameters) {
  const auto share = [&](const char* name) { return readShare(context, parameters, name); };
  Principled principled;
  principled.baseColor = readTexturedRgb(context, parameters, "base_color", 0.5);
  principled.roughness = readTexturedFloat(context, parameters, "roughness", 0.5);
  principled.anisotropic = share("anisotropic");
  principled.specTrans = share("spec_trans");
  principled.specTint = share("spec_tint");
  principled.sheen = share("sheen");
  principled.sheenTint = share("sheen_tint");
  principled.flatness = share("flatness");
  return principled;
}

}  // namespace

void readPrincipled(LoadContext& context, Parameters& parameters, Material& material) {
  Principled principled = readAnyPrincipled(context, parameters);
  principled.metallic = readShare(context, parameters, "metallic");
  principled.clearcoat = readShare(context, parameters, "clearcoat");
  principled.clearcoatGloss = readShare(context, parameters, "clearcoat_gloss");
  const bool transmits = principled.specTrans.texture != kNone || principled.specTrans.value != 0;
  // The index of refraction, given as `eta` or by `specular`. It must not be 1 if light is transmitted.
  if (parameters.has("eta") && parameters.has("specular")) {
    throw LoadError(parameters.locationOf("specular"), "specular stands beside eta; expected one of the two");
  }
  if (parameters.has("eta")) {
    principled.eta = parameters.positiveReal("eta", 1.5);
    if (transmits && principled.eta == 1) principled.eta = 1.001;  // as Mitsuba does: nothing bends without it
  } else {
    double specular = parameters.real("specular", 0.5);
    if (!(specular >= 0 && specular <= 1)) {
      throw LoadError(parameters.locationOf("specular"), "specular is outside of its range; expected 0 to 1");
    }
    if (transmits && specular == 0) specular = 1e-3;
    // The solution of ((eta - 1) / (eta + 1))^2 = 0.08 specular. The left side is the reflectance at normal incidence.
    principled.eta = 2 / (1 - std::sqrt(0.08 * specular)) - 1;
  }
  // These only guide sampling.
  parameters.ignore({"diffuse_reflectance_sampling_rate", "main_specular_sampling_rate", "clearcoat_sampling_rate"});
  material.kind = principled;
}

void readPrincipledThin(LoadContext& context, Parameters& parameters, Material& material) {
  Principled principled = readAnyPrincipled(context, parameters);
  principled.thin = true;
  principled.diffTrans = readShare(context, parameters, "diff_trans", 2);
  const TexturedFloat eta = readTexturedFloat(context, parameters, "eta", 1.5);
  if (eta.texture != kNone || !(eta.value > 0)) {
    throw LoadError(parameters.locationOf("eta"), "eta is not a constant above 0; expected one number");
  }
  principled.eta = eta.value;
  // These only guide sampling.
  parameters.ignore({"diffuse_reflectance_sampling_rate", "specular_reflectance_sampling_rate",
                     "specular_transmittance_sampling_rate", "diffuse_transmittance_sampling_rate"});
  material.kind = principled;
}

}  // namespace wavecrest
