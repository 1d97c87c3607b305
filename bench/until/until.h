// Renders until the image resembles a reference, or is close enough to its expectation.
//
// The image is looked at after numbers of iterations that grow by a quarter at most from the fourth on; for an error by
// an eighth at most, from eight slices on. The render clock stands still meanwhile. From there on a goal is overshot by
// as much at most.
#pragma once

#include <optional>
#include <string>

#include "bench/until/film_error.h"
#include "engine/session/session.h"
#include "metrics/prepared_reference.h"

namespace wavecrest {

struct SsimGoal {
  const PreparedReference& reference;
  double ssim = 0;
};

struct SsimNow {
  uint64_t iterations = 0;     // at the last look
  std::optional<double> ssim;  // nothing while there is no whole image
  bool reached = false;
};

// Goes on to the goal, to the iterations or the time of the settings, or to an interrupt.
SsimNow renderUntilSsim(Session& session, const RenderSettings& settings, const SsimGoal& goal);

struct ErrorNow {
  uint64_t iterations = 0;         // at the last look
  std::optional<FilmError> error;  // nothing while it cannot be told
  bool reached = false;            // all of the interval is at the goal or below
  bool black = false;              // after kBlackIterations: nothing but the goal would end the render, and never does
};

// The relative RMSE of a session's film against its expectation (film_error.h), watched from the first iteration on.
// Merging methods have expectations that their radius blurs: that bias is no part of the error.
class FilmErrorWatch {
 public:
  // Memory that it takes for a film of so many pixels, besides the film that it looks at (MemoryUse::image): the slices
  // and the film before, or one slice less and what the estimate makes of them.
  static constexpr size_t bytesFor(size_t pixels) { return (2 * kFewestSlices + 1) * pixels * 3 * sizeof(float); }

  // Goes on to the goal, to the iterations or the time of the settings, or to an interrupt; without either of them also
  // to a film that is found black. May be called again, for the same session. Settings must be such that whyNoFilmError
  // has nothing to say.
  ErrorNow renderUntil(Session& session, const RenderSettings& settings, double relativeError);

 private:
  FilmSlices slices_;
  ErrorNow now_;
};

// Length of a run, in iterations from the image's first one, such that different runs are independent samples: 1, or
// kSobolRun for Sobol points, which are scrambled anew for each run. spreads: whether the film spreads samples, as it
// does by every filter but a box. Then it is 2 at least: all pixels of an iteration share one place in the filter, and
// an odd iteration has the mirror image of the place before (sharedPlace in kernels/endpoints/camera_lanes.h). The
// places of all pairs are one Sobol sequence: short runs still depend on each other a little, and overestimate the
// error.
inline uint64_t independentRun(SamplerKind sampler, bool spreads) {
  if (sampler == SamplerKind::sobol) return kSobolRun;
  return spreads ? 2 : 1;
}

// Of films of fewer pixels estimateFilmError seldom or never tells an error, however long the render.
constexpr size_t kFewestPixelsOfError = 16;

// Why no runs of iterations of these settings are independent, so that their spread does not tell the error. Empty:
// they are.
std::string whyNoFilmError(const RenderSettings& settings);

}  // namespace wavecrest
