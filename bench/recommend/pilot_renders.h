// Pilots: short renders of whole images, for as long as they were given or for as long as whole images take.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "bench/recommend/prediction.h"
#include "engine/session/session.h"

namespace wavecrest {

// What a second is: of the wall clock while rendering, or of CPU time over the number of threads, which leaves out what
// other programs take on a busy machine.
enum class PilotClock { wall, cpu };
constexpr std::array<std::string_view, 2> kPilotClockNames{"wall", "cpu"};

// A pilot that needs more time for whole images gets up to so many times what it was given.
constexpr double kMostOverrun = 3;

struct PilotRender {
  std::optional<Pilot> pilot;  // nothing where whole images take longer than kMostOverrun allows
  double seconds = 0;          // that it took
  double needed = 0;           // at least: of four whole images
};

// Four renders with seeds from firstSeed on, each for a quarter of the seconds. biased: as of Pilot.
PilotRender renderPilot(const Scene& scene, RenderSettings settings, uint64_t firstSeed, double seconds,
                        PilotClock clock, bool biased);

}  // namespace wavecrest
