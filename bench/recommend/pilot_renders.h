// Pilots: short renders of whole images, for as long as they were given or for as long as whole images take.
#pragma once

#include <optional>

#include "bench/recommend/prediction.h"
#include "engine/inspect/path_classes.h"
#include "engine/plan/clock_kind.h"
#include "engine/session/session.h"

namespace wavecrest {

// A pilot that needs more time for whole images gets up to so many times what it was given.
constexpr double kMostOverrun = 3;

struct PilotRender {
  std::optional<Pilot> pilot;  // nothing where whole images take longer than kMostOverrun allows
  double seconds = 0;          // that it took
  double needed = 0;           // at least: of four whole images
};

// What `render` takes for the method, its sampler with it. settings: of all pilots.
RenderSettings pilotSettings(RenderSettings settings, Method method);

// Those of the reference: pilotSettings, and kFixedRadius where it is biased. An automatic radius may be far larger.
RenderSettings referenceSettings(const RenderSettings& settings, const ReferenceChoice& choice);

// Four renders with seeds from firstSeed on, each for a quarter of the seconds. biased: as of Pilot.
PilotRender renderPilot(const Scene& scene, RenderSettings settings, uint64_t firstSeed, double seconds,
                        ClockKind clock, bool biased);

// Renders until `seconds` of this clock have passed, to within 2 %, or until another step of its chains would not end
// in time. By the clock cpu a session is given more wall time where other processes have taken part of it.
void renderBy(ClockKind clock, Session& session, uint32_t threads, double seconds);

}  // namespace wavecrest
