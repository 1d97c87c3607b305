// A session that is looked at while it renders.
//
// It renders as the session within does, to the same image bit for bit, but returns to itself now and then to take a
// look. The render clock stands still meanwhile. Looks follow each other at a second or more, besides those at
// snapshots and at the end. All that looking costs stays below kMostLooking of the render time, so films that are slow
// to resolve are looked at more rarely; only looks at snapshots and at the end are taken whatever they cost.
//
// The error is that of bench/until/film_error.h, of a sample of the film's blocks. It takes films of equal numbers of
// iterations: how many follows from what the first iteration and two copies of the film have taken.
#pragma once

#include <memory>

#include "bench/live/block_sample.h"
#include "bench/live/look.h"
#include "bench/until/film_error.h"
#include "engine/session/session.h"

namespace wavecrest {

class WatchedSession final : public Session {
 public:
  WatchedSession(std::unique_ptr<Session> session, const RenderSettings& settings, LookTaker taker);

  // The session that renders: the one to interrupt and to resume, which tells of both.
  Session& within() { return *session_; }
  // Looks now: at a snapshot, or at the end.
  void look(bool last);

  void renderUntil(std::optional<uint64_t> iterations, std::optional<double> seconds) override;
  RenderStatistics statistics() const override { return session_->statistics(); }
  const Film& film() const override { return session_->film(); }
  const MemoryPlan& memoryPlan() const override { return session_->memoryPlan(); }
  void save(StateWriter& out) const override { session_->save(out); }
  void restore(StateReader& in) override;
  double progressSeconds() const override { return session_->progressSeconds(); }
  uint64_t progressPaths() const override { return session_->progressPaths(); }

  // Of the render time.
  static constexpr double kMostLooking = 0.005;
  static constexpr double kFirstLook = 0.25;  // seconds
  // Blocks of 8 x 8 pixels that the error is estimated from.
  static constexpr size_t kErrorBlocks = 256;

 private:
  // Iterations at which the film is wanted next for the error, or nothing.
  std::optional<uint64_t> nextSlice() const;
  void renderWatched(std::optional<uint64_t> iterations, std::optional<double> seconds);
  void addSlice(uint64_t iterations);
  // Decides after the first iteration how many a slice is to have.
  void beginSlices();
  void estimateError();
  void takeLook(std::vector<float> film, bool last);
  // Runs a step while the render waits, and notes how long.
  template <class Step>
  void whileWaiting(Step step);

  const std::unique_ptr<Session> session_;
  const LookTaker taker_;
  const BlockSample blocks_;
  const uint64_t run_;                // of iterations that depend on each other, counted from the image's first one
  bool errorKnowable_;                // not where the session begins within a run
  std::optional<FilmSlices> slices_;  // nothing before the first iteration is done
  uint64_t slicesUntil_ = 0;          // iterations of the last slice
  std::optional<FilmError> error_;
  uint64_t errorIterations_ = 0;  // that slicesUntil_ was when the error was estimated
  double nextLook_ = kFirstLook;  // render seconds
  double lookingSeconds_ = 0;     // that the render was kept waiting
};

}  // namespace wavecrest
