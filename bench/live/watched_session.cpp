#include "bench/live/watched_session.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "bench/until/until.h"

namespace wavecrest {
namespace {

constexpr double kLookInterval = 1;  // seconds, at least

}  // namespace

WatchedSession::WatchedSession(std::unique_ptr<Session> session, const RenderSettings& settings, LookTaker taker)
    : session_(std::move(session)),
      taker_(std::move(taker)),
      blocks_(session_->film().area().width, session_->film().area().height, kErrorBlocks),
      run_(independentRun(settings.sampler, session_->film().spreads())),
      errorKnowable_(blocks_.count() > 0 && whyNoFilmError(settings).empty() && settings.firstIteration % run_ == 0) {}

template <class Step>
void WatchedSession::whileWaiting(Step step) {
  const auto begin = std::chrono::steady_clock::now();
  step();
  lookingSeconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void WatchedSession::restore(StateReader& in) {
  session_->restore(in);
  errorKnowable_ = false;  // the films of earlier iterations are gone
}

void WatchedSession::look(bool last) {
  whileWaiting([&] { takeLook(session_->film().resolve(), last); });
}

void WatchedSession::takeLook(std::vector<float> film, bool last) {
  estimateError();
  const FilmArea& area = session_->film().area();
  taker_(std::make_shared<const Look>(
      Look{.image = {.width = area.width, .height = area.height, .channels = 3, .pixels = std::move(film)},
           .iterations = session_->statistics().iterations,
           .paths = session_->progressPaths(),
           .renderSeconds = session_->progressSeconds(),
           .error = error_,
           .errorIterations = errorIterations_,
           .last = last}));
  // The next look comes once all looking so far takes at most half of the share kMostLooking.
  nextLook_ = std::max(session_->progressSeconds() + kLookInterval, lookingSeconds_ / (0.5 * kMostLooking));
}

std::optional<uint64_t> WatchedSession::nextSlice() const {
  if (!errorKnowable_) return std::nullopt;
  // Before slices begin, the film is wanted after one iteration, whose time decides how long slices are.
  return slices_ ? slices_->nextIterations() : 1;
}

void WatchedSession::beginSlices() {
  whileWaiting([&] { takeLook(session_->film().resolve(), false); });
  // Slices are so long that copies of the film take at most half of the share kMostLooking. What a copy costs is the
  // shorter of two: on a busy machine a single one may have waited for others, and would keep the error away for long.
  double copySeconds = std::numeric_limits<double>::infinity();
  for (int copy = 0; copy < 2; ++copy) {
    const double before = lookingSeconds_;
    whileWaiting([&] { blocks_.take(session_->film().resolve()); });
    copySeconds = std::min(copySeconds, lookingSeconds_ - before);
  }
  const double seconds = std::max(session_->progressSeconds(), 1e-6);
  const double rare = std::ceil(copySeconds / (0.5 * kMostLooking * seconds));
  slices_.emplace(std::max(std::bit_ceil(static_cast<uint64_t>(std::clamp(rare, 1.0, 1e9))), run_));
}

void WatchedSession::addSlice(uint64_t iterations) {
  // If slices have more than one iteration, the film after the first one is not used.
  if (!slices_) beginSlices();
  if (slices_->nextIterations() != iterations) return;
  whileWaiting([&] { slices_->add(blocks_.take(session_->film().resolve())); });
  slicesUntil_ = iterations;
}

void WatchedSession::estimateError() {
  if (!slices_ || errorIterations_ == slicesUntil_) return;
  const std::optional<FilmError> now = estimateFilmError(slices_->slices(), BlockSample::kWidth);
  // Where slices are too uneven to tell, the last estimate stays. A film without variance is not taken for one without
  // error before it has many iterations: rare light may not have arrived yet.
  if (!now || (now->value <= kNoVariance && slicesUntil_ < kBlackIterations)) return;
  error_ = now;
  errorIterations_ = slicesUntil_;
}

// A signal or timer interrupts the wrapped session, but callers ask this one whether it was interrupted. So the flag is
// copied from the one to the other, before the render and after.
void WatchedSession::renderUntil(std::optional<uint64_t> iterations, std::optional<double> seconds) {
  if (!session_->interrupted()) resume();
  renderWatched(iterations, seconds);
  if (session_->interrupted()) interrupt();
}

void WatchedSession::renderWatched(std::optional<uint64_t> iterations, std::optional<double> seconds) {
  double lookLimit = nextLook_;
  for (;;) {
    // Render up to the nearest limit: of the caller, of the next slice, or of the next look.
    const std::optional<uint64_t> slice = nextSlice();
    const double due = nextLook_;
    session_->renderUntil(earlier(iterations, slice), earlier(seconds, std::optional(lookLimit)));
    if (session_->interrupted()) return;

    // Find out which limit ended it.
    const uint64_t done = session_->statistics().iterations;
    const double now = session_->progressSeconds();
    const bool sliceReached = slice && done == *slice, allDone = iterations && done >= *iterations;
    // Otherwise the time ended it: chains may end a moment before theirs, where another step does not fit in.
    const bool timeEnded = !sliceReached && !allDone;
    if (sliceReached) addSlice(done);
    // Callers look themselves where their own limit ends it: at a snapshot, or at the end.
    if (allDone || (seconds && (now >= *seconds || (timeEnded && *seconds <= lookLimit)))) return;
    // A look changes nextLook_: where slices have just begun with one, another is not due yet.
    if (nextLook_ == due && now >= due) look(false);
    // Where no step fits in before the limit, it moves on until one does. The look comes after that step.
    lookLimit = timeEnded && now < due ? lookLimit + (lookLimit - now) : nextLook_;
  }
}

}  // namespace wavecrest
