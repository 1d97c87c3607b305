// The page of `converge --view`: runs, curves and what is left, as they come.
#pragma once

#include <string>

#include "bench/campaign/run_campaign.h"
#include "bench/live/live_server.h"
#include "wavecrest/results.h"

namespace wavecrest {

class CampaignView {
 public:
  // scenes, methods, seeds: of the whole campaign.
  CampaignView(const HostPort& address, const CampaignSettings& settings);

  const std::string& url() const { return server_.url(); }
  // Runs of earlier processes.
  void showEarlier(const CampaignResults& results);
  void showPlan(const CampaignPlan& plan);
  void showRun(const RunRecord& run, const CampaignProgress& progress);
  void showEnd(bool complete);

 private:
  void publishRun(const RunRecord& run);

  LiveServer server_;
};

}  // namespace wavecrest
