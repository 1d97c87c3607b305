// How long a campaign still takes.
#pragma once

#include "bench/campaign/campaign_settings.h"
#include "bench/campaign/run_campaign.h"
#include "bench/campaign/scene_reference.h"

namespace wavecrest {

// Estimates the time left from the wall time that finished work took. Work is counted in render seconds. Where
// iterations are counted, a run is one unit, as all runs are taken for equally long.
class Pace {
 public:
  explicit Pace(const CampaignSettings& settings) : settings_(settings) {}

  // Units of work: of a run, and of rendering a reference.
  double ofRun(const CampaignScene& scene) const { return settings_.iterations ? 1 : scene.effort.seconds; }
  double ofReference(const CampaignScene& scene) const { return kReferenceEffort * ofRun(scene); }

  // ahead: work of all runs and references that are missing.
  void begin(const CampaignPlan& plan, double ahead) {
    progress_ = {.done = plan.done, .total = plan.runs};
    ahead_ = ahead;
  }
  // Takes a finished run into account. wallSeconds: what it took, measuring included.
  const CampaignProgress& finish(const CampaignScene& scene, double wallSeconds) {
    ++progress_.done;
    pass(ofRun(scene), wallSeconds);
    progress_.secondsLeft = ahead_ * wallSeconds_ / passed_;
    return progress_;
  }
  void finishReference(const CampaignScene& scene, double wallSeconds) { pass(ofReference(scene), wallSeconds); }

 private:
  void pass(double charged, double wallSeconds) {
    ahead_ -= charged;
    passed_ += charged;
    wallSeconds_ += wallSeconds;
  }

  const CampaignSettings& settings_;
  CampaignProgress progress_;
  double ahead_ = 0, passed_ = 0, wallSeconds_ = 0;
};

}  // namespace wavecrest
