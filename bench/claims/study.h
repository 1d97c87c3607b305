// The study's protocol, in numbers: what its text says (V.B, VI), and one assumption about its speed.
#pragma once

#include <algorithm>
#include <iterator>
#include <string_view>

namespace wavecrest {

// 1024x768 pixels, and as many light paths in an iteration: SmallVCM's rule, which the study's methods were ported
// from.
constexpr double kStudyPixels = 1024.0 * 768.0;
constexpr double kStudyRadius = 0.001;  // of the first merges, relative to the bounding sphere's

// Simple, intermediate and complex scenes had 30, 60 and 120 minutes: in proportion 1, 2, 4. Scenes of others count as
// intermediate.
enum class StudyComplexity { simple, intermediate, complex };
constexpr StudyComplexity studyComplexity(std::string_view scene) {
  constexpr std::string_view kSimple[] = {"cornell-diffuse", "cornell-mirror", "cornell-glossy"};
  constexpr std::string_view kComplex[] = {"dragon-caustics", "dragon-caustics-glossy", "veach-door"};
  const auto in = [&](const auto& list) {
    return std::find(std::begin(list), std::end(list), scene) != std::end(list);
  };
  if (in(kSimple)) return StudyComplexity::simple;
  return in(kComplex) ? StudyComplexity::complex : StudyComplexity::intermediate;
}
constexpr double studyMinutes(std::string_view scene) {
  constexpr double kMinutes[] = {30, 60, 120};
  return kMinutes[static_cast<int>(studyComplexity(scene))];
}

// The study counts no paths. Its photon mapping follows SmallVCM, whose ppm traces 0.12 million camera paths and as
// many light paths a second on one core of an AMD EPYC (bench/peers); the study had eight cores, of 2012. The
// figure is good to a factor of three: enough to tell a tenth of the study's paths from all of them.
constexpr double kStudyCores = 8, kPathsPerSecondOfCore = 2 * 0.12e6;  // light and camera paths
constexpr double studyPathsPerPixel(std::string_view scene) {
  return kStudyCores * kPathsPerSecondOfCore * 60 * studyMinutes(scene) / kStudyPixels;
}

}  // namespace wavecrest
