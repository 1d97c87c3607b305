#include "bench/tradeoff/knobs.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "bench/enumerator_name.h"
#include "engine/compile/compiled_scene.h"
#include "engine/film/film.h"
#include "engine/plan/render_plan.h"
#include "kernels/stages.h"

namespace wavecrest {
namespace {

// Collects variants of the baseline. The reference that add() returns is valid until the next add().
class Variants {
 public:
  explicit Variants(const RenderSettings& base) : base_(base) {}

  // A copy of the baseline to be changed.
  RenderSettings& add(std::string_view knob, std::string_view value, bool samePaths = false) {
    return all_.emplace_back(Variant{std::string(knob), std::string(value), base_, samePaths}).settings;
  }
  std::vector<Variant> take() { return std::move(all_); }

 private:
  const RenderSettings& base_;
  std::vector<Variant> all_;
};

// What leaves the paths as they are but for rounding: precision, instruction set, kernels, size of waves.
void addArithmetic(Variants& variants, const RenderSettings& base) {
  variants.add("--precision", "double", true).precision = Precision::doubled;
  for (const Isa isa : availableIsas()) {
    if (isa != base.isa) variants.add("--isa", toString(isa), true).isa = isa;
  }
  variants.add("kernels", "complete", true).specialization = Specialization::complete;
  for (const uint32_t wave : {512u, 8192u}) {
    variants.add("--wave", std::to_string(wave), true).waveSize = wave;
  }
}

// What changes the paths. A depth limit is varied downwards only. Of the chains those of pssmlt alone play roulette.
void addPaths(Variants& variants, const RenderSettings& base) {
  for (const uint32_t depth : {4u, 8u, 16u}) {
    if (depth < base.limits.maxDepth) variants.add("--max-depth", std::to_string(depth)).limits.maxDepth = depth;
  }
  const bool hasRoulette = base.method != Method::mlt || base.metropolis.variant == MetropolisVariant::pssmlt;
  for (const uint32_t depth : {2u, 5u, 12u}) {
    if (hasRoulette && depth != base.limits.rouletteDepth) {
      variants.add("--rr-depth", std::to_string(depth)).limits.rouletteDepth = depth;
    }
  }
  for (const Roulette roulette : {Roulette::throughput, Roulette::albedo, Roulette::efficiency}) {
    if (!hasRouletteChoice(base.method) || roulette == base.roulette) continue;
    variants.add("--roulette", enumeratorName(kRouletteNames, roulette)).roulette = roulette;
  }
  // Chains draw their own numbers.
  if (base.method != Method::mlt) {
    const SamplerKind other = base.sampler == SamplerKind::sobol ? SamplerKind::independent : SamplerKind::sobol;
    variants.add("--sampler", toString(other)).sampler = other;
  }
}

void addFilter(Variants& variants, const RenderSettings& base) {
  const FilterMode other = base.filterMode == FilterMode::spread ? FilterMode::sample : FilterMode::spread;
  variants.add("--filter-mode", enumeratorName(kFilterModeNames, other)).filterMode = other;
}

// What decides the bias and noise of merging. Light paths are multiples of one per pixel.
void addMerging(Variants& variants, const RenderSettings& base, uint64_t pixels) {
  for (const double factor : {0.25, 4.0}) {
    const double radius = factor * base.radius.value();
    variants.add("--radius", fmt::format("{:g}", radius)).radius = radius;
    const auto paths = static_cast<uint64_t>(factor * static_cast<double>(pixels));
    variants.add("--light-paths", std::to_string(paths)).lightPaths = paths;
  }
  for (const double alpha : {0.5, 0.9}) {
    variants.add("--radius-alpha", fmt::format("{:g}", alpha)).radiusAlpha = alpha;
  }
}

// Small scenes join all connections, whatever the setting.
bool isSmall(const Scene& scene, const RenderSettings& settings) {
  return compileScene<float>(scene, settings.accel)->accel() == Accel::small;
}

// Intersectors, which find the same hits but for rounding. roulette: whether connections play it, which `small` never
// does. small: whether the baseline's intersector is that one.
void addTracing(Variants& variants, bool roulette, bool small) {
  for (const Accel accel : {Accel::small, Accel::bvh, Accel::embree}) {
    const bool samePaths = !roulette || (accel == Accel::small) == small;
    variants.add("--accel", enumeratorName(kAccelNames, accel), samePaths).accel = accel;
  }
}

// Shares of the brightness below which connections play roulette; 0 turns the roulette off.
void addConnections(Variants& variants) {
  for (const double part : {0.0, 0.05, 0.8}) {
    variants.add("--connection-roulette", fmt::format("{:g}", part)).connectionRoulette = part;
  }
}

// Variant, number of chains, and the separate pass for direct light.
void addChains(Variants& variants, const RenderSettings& base) {
  for (size_t i = 0; i < kMetropolisVariantNames.size(); ++i) {
    const auto variant = static_cast<MetropolisVariant>(i);
    if (variant == base.metropolis.variant) continue;
    variants.add("--mlt", kMetropolisVariantNames[i]).metropolis.variant = variant;
  }
  for (const uint32_t chains : {2048u, 65536u}) {
    variants.add("--chains", std::to_string(chains)).metropolis.chains = chains;
  }
  variants.add("--no-direct-pass", "").metropolis.directPass = false;
}

}  // namespace

std::vector<Variant> variantsOf(const Scene& scene, const RenderSettings& base) {
  Variants variants(base);
  // chooseVariants expects the baseline first and double precision second.
  variants.add("baseline", enumeratorName(kPrecisionNames, base.precision), true);
  addArithmetic(variants, base);
  const bool hasRoulette = hasConnectionRoulette(base.method), small = hasRoulette && isSmall(scene, base);
  addTracing(variants, hasRoulette && base.connectionRoulette != 0, small);
  addPaths(variants, base);
  // A box filter is the same in both modes.
  if (scene.film.filter != ReconstructionFilter::box) addFilter(variants, base);
  if (strategiesOf(base.method).merge) addMerging(variants, base, filmArea(scene.film).pixels.size());
  if (hasRoulette && !small) addConnections(variants);
  if (base.method == Method::mlt) addChains(variants, base);
  return variants.take();
}

namespace {

bool isCalled(const Variant& variant, std::string_view word) {
  const auto bare = [](std::string_view knob) {
    return knob.substr(std::min(knob.find_first_not_of('-'), knob.size()));
  };
  return bare(variant.knob) == bare(word);
}

}  // namespace

bool hasKnob(std::span<const Variant> all, std::string_view word) {
  return std::any_of(all.begin() + 1, all.end(), [&](const Variant& variant) { return isCalled(variant, word); });
}

std::vector<Variant> chooseVariants(std::vector<Variant> all, std::span<const std::string> knobs) {
  std::vector<Variant> chosen;
  for (size_t i = 0; i < all.size(); ++i) {
    // The baseline and double precision, with which the others are compared.
    const bool compared = i < 2;
    if (compared || std::any_of(knobs.begin(), knobs.end(), [&](const auto& word) { return isCalled(all[i], word); })) {
      chosen.push_back(std::move(all[i]));
    }
  }
  return chosen;
}

}  // namespace wavecrest
