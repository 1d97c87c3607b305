#include "engine/load/integrator.h"

#include "engine/load/parameters.h"
#include "engine/load/values.h"

namespace wavecrest {

namespace {

// Integrators of Mitsuba 0.5 to 3 and the method here that estimates the same light by the same kind of paths.
struct IntegratorMethod {
  std::string_view type, method;
};
constexpr IntegratorMethod kMethodOf[] = {
    {"path", "pt"},          {"direct", "pt"},    {"volpath", "pt"},    {"volpathmis", "pt"}, {"volpath_simple", "pt"},
    {"prb", "pt"},           {"prb_basic", "pt"}, {"prbvolpath", "pt"}, {"vpl", "pt"},        {"ptracer", "lt"},
    {"adjoint", "lt"},       {"bdpt", "bpt"},     {"pssmlt", "mlt"},    {"mlt", "mlt"},       {"erpt", "mlt"},
    {"photonmapper", "bpm"}, {"ppm", "ppm"},      {"sppm", "ppm"},      {"vcm", "vcm"},       {"upm", "vcm"}};

std::string_view methodOf(std::string_view type) {
  for (const IntegratorMethod& known : kMethodOf) {
    if (known.type == type) return known.method;
  }
  return {};
}

void noteMethod(LoadContext& context, const Parameters& parameters, const std::string& leftOver) {
  const std::string_view type = parameters.object().get("type"), method = methodOf(type);
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
  // `direct` is what a path tracer does with two edges.
  const int64_t fallback = element.get("type") == "direct" ? 2 : -1;
  defaults.maxDepth = static_cast<int>(parameters.integer("max_depth", fallback, -1, kMost));
  if (defaults.maxDepth == 0) {
    throw LoadError(parameters.locationOf("max_depth"),
                    "max_depth is 0, with which nothing is seen; expected -1, or 1 or more");
  }
  defaults.rrDepth = static_cast<int>(parameters.integer("rr_depth", 5, 1, kMost));
  defaults.hideEmitters = parameters.boolean("hide_emitters", false);
  noteMethod(context, parameters, parameters.takeOthers());
}

}  // namespace wavecrest
