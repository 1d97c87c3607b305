#include "engine/load/integrator.h"

#include "engine/load/parameters.h"
#include "engine/load/values.h"

namespace wavecrest {

namespace {

// Integrators of Mitsuba 0.5 to 3, the method here that estimates the same light by the same kind of paths, as options
// of the command line, and what max_depth is where a file does not say.
struct KnownIntegrator {
  std::string_view type, method;
  int64_t maxDepth = -1;
};
// `direct` is what a path tracer does with two edges.
constexpr KnownIntegrator kIntegrators[] = {{"path", "pt"},
                                            {"direct", "pt", 2},
                                            {"direct_projective", "pt", 2},
                                            {"direct_reparam", "pt", 2},
                                            {"volpath", "pt"},
                                            {"volpathmis", "pt"},
                                            {"volpath_simple", "pt"},
                                            {"prb", "pt", 6},
                                            {"prb_basic", "pt", 6},
                                            {"prb_projective", "pt", 6},
                                            {"prb_reparam", "pt", 6},
                                            {"prbvolpath", "pt", 6},
                                            {"vpl", "pt", 5},
                                            {"ptracer", "lt"},
                                            {"adjoint", "lt"},
                                            {"bdpt", "bpt"},
                                            {"pssmlt", "mlt"},
                                            {"mlt", "mlt --mlt pathspace"},
                                            {"erpt", "mlt --mlt pathspace"},
                                            {"photonmapper", "ppm --direct-pass"},
                                            {"ppm", "ppm"},
                                            {"sppm", "ppm"},
                                            {"vcm", "vcm"},
                                            {"upm", "vcm"}};

// Parameters of these integrators that guide how they sample, and do not change what they estimate.
constexpr std::string_view kSamplingParameters[] = {
    // Of several integrators.
    "samples_per_pass", "block_size", "timeout", "granularity", "work_units", "emitter_samples", "bsdf_samples",
    "shading_samples", "direct_samples", "sample_direct", "light_image", "brute_force", "use_spectral_mis",
    // Of the projective ones, and of those that reparameterise.
    "sppc", "sppp", "sppi", "guiding", "guiding_proj", "guiding_rounds", "project_seed", "reparam_max_depth",
    "reparam_rays", "reparam_kappa", "reparam_exp", "reparam_antithetic", "reparam_unroll",
    // Of photons and of vpl.
    "photon_count", "initial_radius", "alpha", "max_passes", "global_photons", "caustic_photons", "volume_photons",
    "global_lookup_radius", "caustic_lookup_radius", "volume_lookup_radius", "lookup_size", "glossy_samples",
    "shadow_map_resolution",
    // Of Markov chains.
    "luminance_samples", "two_stage", "p_large", "bidirectional", "num_chains", "max_chains", "chain_length",
    "bidirectional_mutation", "lens_perturbation", "caustic_perturbation", "multi_chain_perturbation",
    "manifold_perturbation", "lambda", "prob_factor"};

// Any other type has no method and no limit.
KnownIntegrator integratorOf(std::string_view type) {
  for (const KnownIntegrator& known : kIntegrators) {
    if (known.type == type) return known;
  }
  return {};
}

void noteMethod(LoadContext& context, const Parameters& parameters, const std::string& leftOver) {
  const std::string_view method = integratorOf(parameters.object().get("type")).method;
  const std::string what = parameters.describe() + (leftOver.empty() ? "" : " with " + leftOver);
  if (method.empty()) {
    context.note(parameters.location(), what, "no method here is like it; the command line chooses what is rendered");
  } else if (method != "pt") {
    context.note(parameters.location(), what,
                 "the command line chooses the method; --method " + std::string(method) + " is the like of it");
  } else if (!leftOver.empty()) {
    context.note(parameters.location(), what, "left out: guides how the integrator samples");
  }
}

// The sampling parameters that the file gives, "a, b". Reports all others, except those of an integrator that no method
// is like.
std::string takeSamplingParameters(Parameters& parameters) {
  if (integratorOf(parameters.object().get("type")).method.empty()) return parameters.takeOthers();
  std::string names = parameters.takeOthers(kSamplingParameters);
  parameters.finish();
  return names;
}

}  // namespace

void readIntegrator(LoadContext& context, const XmlElement& element) {
  const ReadingGuard guard(context, element);
  Parameters parameters(context, element);
  const std::vector<const XmlElement*> nested = parameters.objects("integrator");
  if (!nested.empty()) {
    context.note(element.location(), parameters.describe(),
                 "only the image of its " + (nested.size() > 1 ? std::string("first ") : "") + "nested integrator " +
                     inQuotes(nested.front()->get("type")) + " is rendered");
    return readIntegrator(context, *nested.front());
  }
  RenderDefaults& defaults = context.scene.defaults;
  constexpr int64_t kMost = 1'000'000'000;
  const std::string_view type = element.get("type");
  const int64_t fallback = integratorOf(type).maxDepth;
  // These have two edges, whatever they state.
  const bool isFixed = type == "direct" || type == "direct_projective" || type == "direct_reparam";
  if (isFixed) parameters.leaveOut({"max_depth"}, "left out: paths of this integrator have two edges");
  defaults.maxDepth = static_cast<int>(isFixed ? fallback : parameters.integer("max_depth", fallback, -1, kMost));
  if (defaults.maxDepth == 0) {
    throw LoadError(parameters.locationOf("max_depth"),
                    "max_depth is 0, with which nothing is seen; expected -1, or 1 or more");
  }
  defaults.rrDepth = static_cast<int>(parameters.integer("rr_depth", 5, 1, kMost));
  defaults.hideEmitters = parameters.boolean("hide_emitters", false);
  if (parameters.boolean("strict_normals", false)) {
    parameters.leaveOut({"strict_normals"}, "left out: shading normals alone decide");
  }
  noteMethod(context, parameters, takeSamplingParameters(parameters));
}

}  // namespace wavecrest
