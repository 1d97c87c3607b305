// The intersection stages against bare Embree on the same rays.
//
// Rays of real waves, of every depth, are put into Embree's packets beforehand; what is timed is the calls of
// rtcIntersect16 and rtcOccluded16 and nothing else: on a scene with Embree's robust flag, and on one without. Our
// stages are timed on the same rays where they are in the wave, reading and writing columns included. Both in CPU time,
// in turn at each depth of each wave.
#pragma once

#include <cstdint>
#include <optional>

#include "engine/plan/render_settings.h"

namespace wavecrest {

struct RayRates {
  uint64_t rays = 0;
  double bare = 0;         // rays per second of bare Embree on one core, with its robust flag
  double notRobust = 0;    // and without it, as Mitsuba uses it: rays may slip through edges
  double embreeStage = 0;  // of our stage on Embree
  double usedStage = 0;    // of the stage that renders this scene: the same, or the small-scene intersector's
};

struct BareEmbree {
  RayRates closest, anyHit;
  // Rays of both kinds as a render mixes them, per CPU second of Embree alone.
  double raysPerSecond() const {
    const double seconds = static_cast<double>(closest.rays) / closest.bare + secondsAnyHit();
    return static_cast<double>(closest.rays + anyHit.rays) / seconds;
  }

 private:
  double secondsAnyHit() const { return anyHit.rays == 0 ? 0 : static_cast<double>(anyHit.rays) / anyHit.bare; }
};

// Takes waves from all over the film until `seconds` have passed, at least one. Precision is float: Embree's.
// Nothing for a method with light paths or chains.
std::optional<BareEmbree> measureBareEmbree(const Scene& scene, const RenderSettings& settings, double seconds);

}  // namespace wavecrest
