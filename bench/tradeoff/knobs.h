// The settings that buy speed, accuracy or memory, one changed at a time.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/plan/render_settings.h"
#include "engine/scene/scene.h"

namespace wavecrest {

struct Variant {
  std::string knob, value;  // as on the command line
  RenderSettings settings;
  // The paths are those of the baseline: what differs from it is rounding and what follows from that, not noise.
  bool samePaths = false;
};

// The baseline first, then double precision, then every other setting that means something for the method and the
// scene. base: the settings that are varied, of precision float.
std::vector<Variant> variantsOf(const Scene& scene, const RenderSettings& base);

// Whether a variant besides the baseline has this word as its knob, written with or without leading dashes.
bool hasKnob(std::span<const Variant> all, std::string_view word);

// The baseline, double precision, and those of the variants whose knob is one of these words.
std::vector<Variant> chooseVariants(std::vector<Variant> all, std::span<const std::string> knobs);

}  // namespace wavecrest
