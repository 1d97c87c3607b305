// Convergence campaigns, and what they found out.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "wavecrest/campaign_options.h"
#include "wavecrest/export.h"
#include "wavecrest/results.h"

namespace wavecrest::api {

// Plain data, declared in the header above: scenes, runs with their snapshots and scores, biases, claims.
using wavecrest::BiasRecord;
using wavecrest::CampaignResults;
using wavecrest::ClaimRecord;
using wavecrest::RunRecord;
using wavecrest::RunState;
using wavecrest::SceneRecord;
using wavecrest::SnapshotRecord;

struct CampaignProgress {
  size_t done = 0, total = 0;  // runs
  double secondsLeft = 0;      // about
};

// A wish to stop a campaign, from another thread or a signal handler, at any time while this lives.
class WAVECREST_EXPORT StopRequest {
 public:
  void request() noexcept;
  bool requested() const noexcept { return requested_.load(); }

 private:
  friend struct StopWatch;  // library/stop_watch.h, which says what renders
  std::atomic<bool> requested_{false};
  std::atomic<void*> session_{nullptr};
  std::atomic<int> requesting_{0};  // requests under way
};

struct CampaignCallbacks {
  std::function<void(const RunRecord&, const CampaignProgress&)> finished;  // after each run
  std::function<void(const std::string&)> say;                              // what people should know, line by line
};

// Renders every scene by every method, measures all snapshots, stores results.sqlite, and at the end judges the study's
// findings and writes report.html. True: all is done; false: it was stopped and `resume` goes on. Throws Error.
WAVECREST_EXPORT bool converge(const CampaignOptions& options, const CampaignCallbacks& callbacks = {},
                               StopRequest* stop = nullptr);

// A results file, or the folder of a campaign. Throws Error.
WAVECREST_EXPORT CampaignResults readResults(const std::string& path);

// Writes the folder's report.html, from a campaign or from renders with stats and a reference; returns its path.
WAVECREST_EXPORT std::string writeReport(const std::string& folder);

}  // namespace wavecrest::api
