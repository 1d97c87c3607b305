#include "bench/until/until.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>
#include <vector>

#include "bench/film_image.h"

namespace wavecrest {
namespace {

// Iterations until the next look: a power of two, which waves of several iterations at once divide well.
uint64_t nextBlock(uint64_t done) { return std::max<uint64_t>(std::bit_floor(done) / 4, 1); }

double ssimNow(const Session& session, const PreparedReference& reference) {
  const ComparedImage test = reference.prepareTest("render", {filmImage(session), Encoding::linear, {}});
  return reference.ssim().compare(test.codes).mean;
}

}  // namespace

SsimNow renderUntilSsim(Session& session, const RenderSettings& settings, const SsimGoal& goal) {
  const uint64_t most = settings.iterations.value_or(std::numeric_limits<uint64_t>::max());
  // Where an earlier call was interrupted, the looks that are behind are left out. Those ahead stay where they were.
  const uint64_t done = session.statistics().iterations;
  SsimNow now;
  for (uint64_t asked = 0; !now.reached && asked < most;) {
    asked += std::min(nextBlock(asked), most - asked);
    if (asked < done) continue;
    session.renderUntil(asked, settings.seconds);
    now.iterations = session.statistics().iterations;
    if (now.iterations == 0) break;  // no whole image
    now.ssim = ssimNow(session, goal.reference);
    now.reached = *now.ssim >= goal.ssim;
    if (now.iterations < asked) break;  // its time is over, or it was interrupted
  }
  return now;
}

ErrorNow FilmErrorWatch::renderUntil(Session& session, const RenderSettings& settings, double relativeError) {
  const uint64_t most = settings.iterations.value_or(std::numeric_limits<uint64_t>::max());
  if (now_.iterations == 0 && slices_.slices().empty()) {
    slices_ = FilmSlices(independentRun(settings.sampler, session.film().spreads()));
  }
  const bool endless = !settings.iterations && !settings.seconds;
  while (!now_.reached && !now_.black) {
    const uint64_t next = slices_.nextIterations();
    session.renderUntil(std::min(next, most), settings.seconds);
    if (session.statistics().iterations == next) {
      std::vector<float> film = session.film().resolve();
      now_.black = endless && next >= kBlackIterations && isBlack(film);
      slices_.add(std::move(film));
      now_.iterations = next;
      now_.error = estimateFilmError(slices_.slices(), session.film().area().width);
      if (now_.error && now_.error->value <= kNoVariance && next < kBlackIterations) now_.error.reset();
      now_.reached = now_.error && now_.error->interval.high <= relativeError;
    }
    if (next >= most || session.statistics().iterations < next) break;  // its time is over, or it was interrupted
  }
  return now_;
}

std::string whyNoFilmError(const RenderSettings& settings) {
  if (settings.method == Method::mlt)
    return "chains of mlt go on from where they were, so its iterations are not independent";
  return {};
}

}  // namespace wavecrest
