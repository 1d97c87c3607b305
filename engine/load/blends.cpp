// BSDFs that are sums of others: Mitsuba 3's `blendbsdf`, and `mixturebsdf` of Mitsuba 0.6.
//
// Blends of constant weights within each other become one. Bump and normal maps belong around a blend, and a blend with
// a textured weight has no blends within and is in none.
#include <algorithm>
#include <numeric>

#include "engine/load/bsdfs.h"
#include "engine/load/materials.h"
#include "engine/load/values.h"

namespace wavecrest {

namespace {

void refuse(LoadContext& context, const XmlElement& part, const std::string& what) {
  context.unsupported(part.location(), what);
}

// The index of the material of a part that is no blend. With --lenient an inner blend is replaced by its first part,
// and a bump or normal map is removed.
uint32_t singlePartOf(LoadContext& context, const XmlElement& element) {
  const uint32_t index = materialOf(context, element);
  if (const auto* inner = std::get_if<Blend>(&context.scene.materials[index].kind)) {
    refuse(context, element,
           "a blend within another is supported where both weights are constants and nothing is between them; expected "
           "no blend here");
    return inner->materials.front();
  }
  if (!context.scene.materials[index].hasMap()) return index;
  refuse(context, element, "a bump or normal map within a blend is not supported; expected it around the blend");
  // Remove the map from a copy, as the material may also be used outside of a blend.
  Material plain = context.scene.materials[index];
  plain.bumpTexture = plain.normalTexture = kNone;
  context.scene.materials.push_back(std::move(plain));
  return static_cast<uint32_t>(context.scene.materials.size() - 1);
}

bool isBlend(const XmlElement& element) {
  return element.get("type") == "blendbsdf" || element.get("type") == "mixturebsdf";
}

// Far more parts than kernels take, of which those of weight 0 are still to be removed. Each level of blends that name
// one BSDF twice doubles them.
constexpr size_t kMostRead = 1024;

// Adds a part to a blend of constant weights. If the part is such a blend itself, adds its parts instead, with the
// products of the weights.
void addPart(LoadContext& context, const XmlElement& element, double weight, Blend& blend) {
  Material inner;
  if (isBlend(element)) {
    readBsdf(context, element, inner);
    const auto& parts = std::get<Blend>(inner.kind);
    if (parts.weightTexture == kNone) {
      for (size_t i = 0; i < parts.materials.size(); ++i) {
        blend.materials.push_back(parts.materials[i]);
        blend.weights.push_back(weight * parts.weights[i]);
      }
      if (blend.materials.size() > kMostRead) {
        throw LoadError(element.location(), "a blend of " + std::to_string(blend.materials.size()) +
                                                " BSDFs; expected at most " + std::to_string(kMostRead));
      }
      return;
    }
  }
  blend.materials.push_back(singlePartOf(context, element));
  blend.weights.push_back(weight);
}

// The weights of a mixture: at least 0, and small enough that no sum overflows.
std::vector<double> readWeights(Parameters& parameters) {
  const std::string text = parameters.requiredString("weights");
  std::vector<double> weights = parseReals(text, parameters.locationOf("weights"));
  if (std::ranges::any_of(weights, [](double w) { return !(w >= 0 && w <= 1e6); })) {
    throw LoadError(parameters.locationOf("weights"), "weights " + inQuotes(text) + "; expected numbers from 0 on");
  }
  return weights;
}

}  // namespace

void readBlend(LoadContext& context, Parameters& parameters, Material& material) {
  const TexturedFloat weight = readTexturedFloat(context, parameters, "weight", 0.5);
  const std::vector<const XmlElement*> parts = parameters.objects("bsdf");
  if (parts.size() != 2) {
    throw LoadError(parameters.location(), parameters.describe() + " contains " + std::to_string(parts.size()) +
                                               " objects <bsdf>; expected exactly 2");
  }
  Blend blend;
  // The second BSDF has the weight, and the first has 1 minus the weight.
  if (weight.texture == kNone) {
    const double second = std::clamp(weight.value, 0.0, 1.0);
    addPart(context, *parts[0], 1 - second, blend);
    addPart(context, *parts[1], second, blend);
  } else {
    blend.weightTexture = weight.texture;
    for (const XmlElement* part : parts) blend.materials.push_back(singlePartOf(context, *part));
  }
  material.kind = std::move(blend);
}

void readMixture(LoadContext& context, Parameters& parameters, Material& material) {
  std::vector<double> weights = readWeights(parameters);
  const std::vector<const XmlElement*> parts = parameters.objects("bsdf");
  if (parts.size() != weights.size() || parts.empty()) {
    throw LoadError(parameters.location(), parameters.describe() + " has " + std::to_string(parts.size()) +
                                               " objects <bsdf> and " + std::to_string(weights.size()) +
                                               " weights; expected as many of both");
  }
  // As in Mitsuba 0.6, weights of more than 1 together are scaled. If they are less, the rest of the light is absorbed.
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  if (sum > 1) {
    context.note(parameters.locationOf("weights"), "weights of more than 1 together", "scaled to 1");
    for (double& weight : weights) weight /= sum;
  }
  Blend blend;
  for (size_t i = 0; i < parts.size(); ++i) addPart(context, *parts[i], weights[i], blend);
  material.kind = std::move(blend);
}

}  // namespace wavecrest
