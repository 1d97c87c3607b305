// What a session learns from block to block (engine/learn/blocks.h), whatever that is: a wave session asks here what
// its waves read, gives what they leave behind, and folds it when a block is over.
//
// Iterations are counted from the session's first. Another lesson is a Fold of the page, a member here that gathers,
// folds, saves and restores, and a view of it in StageContext.
#pragma once

#include <optional>

#include "engine/film/film.h"
#include "engine/learn/blocks.h"
#include "engine/learn/guide.h"
#include "engine/learn/path_worth.h"
#include "engine/plan/render_plan.h"

namespace wavecrest {

template <class S>
class Learner {
 public:
  // Learns nothing.
  Learner() = default;
  // What the plan's page learns. pixels: of the film.
  Learner(const RenderPlan<S>& plan, const RenderSettings& settings, size_t pixels);

  bool learns() const { return guide_.has_value(); }
  // The first iteration behind the block under way.
  uint64_t blockEnd() const { return blockEnd_; }
  // The first iteration behind `iteration` that no wave with it may have.
  uint64_t endOfRun(uint64_t iteration) const {
    return learns() ? wavecrest::endOfRun(iteration, gathering_) : std::numeric_limits<uint64_t>::max();
  }

  // What the stages of an iteration's camera walk read, and whether they keep records.
  void prepare(StageContext<S>& context, uint64_t iteration) const;
  // Takes what the walk has left in the wave. Safe from several threads.
  void gather(const Wave<S>& wave, uint64_t iteration);
  // All waves have ended the block. Begins the next one. film: of the session, which has all of its samples.
  void fold(const Film& film);

  std::optional<GuideStatistics> guideStatistics() const;
  // At the first vertex with more than delta lobes of a path through a pixel of the image; none where the path has no
  // such vertex or nothing learns directions.
  std::optional<LearnedDirections> learnedDirections(const RenderPlan<S>& plan, const RenderSettings& settings,
                                                     uint32_t x, uint32_t y) const;
  size_t bytes() const { return guide_ ? guide_->statistics().bytes : 0; }
  void save(StateWriter& out) const;
  // Throws StateError.
  void restore(StateReader& in);

 private:
  void updateView();

  std::optional<Guide> guide_;
  std::optional<PathWorth> worth_;  // none where roulette does not go by it
  GuideView view_;
  uint64_t gathering_ = 0;  // iterations of a block that gather, at most
  uint64_t blockEnd_ = 1;
};

}  // namespace wavecrest
