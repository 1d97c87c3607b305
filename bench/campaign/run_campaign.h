// A campaign from start to end, or from wherever an earlier process stopped.
//
// Before the first run every scene that is not done is loaded once and its reference looked for, so that what would
// stop a campaign in its middle (a file that is missing, a scene that changed) stops it at once.
//
// Scene by scene: load it, get its reference, then seed by seed every method, one run at a time with the machine to
// itself; seeds are the outer loop so that a machine that warms up or is shared does so for all methods alike. Each run
// is written into the results file as a whole once it is over. What is there already is not rendered again,
// unless it was asked for less time or fewer iterations than now: then a longer run takes its place.
//
// One process at a time works on a results file. One that cannot begin leaves neither folder nor file.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/campaign/campaign_settings.h"
#include "bench/campaign/session_hooks.h"
#include "wavecrest/results.h"

namespace wavecrest {

// What is ahead of a shard.
struct CampaignPlan {
  size_t runs = 0, done = 0;              // done: by earlier processes
  double renderSeconds = 0;               // of the runs ahead; 0 where iterations are counted
  std::vector<std::string> unreferenced;  // scenes whose reference is to be rendered first
  double referenceSeconds = 0;            // of those
};

struct CampaignProgress {
  size_t done = 0, total = 0;  // runs of this shard, those of earlier processes included
  double secondsLeft = 0;      // about
};

struct CampaignHooks {
  SessionHooks session;
  std::function<bool()> stopped;  // true: return at once, without the run under way
  std::function<void(const CampaignPlan&)> planned;
  std::function<void(const RunRecord&, const CampaignProgress&)> finished;
  std::function<void(const std::string&)> say;  // what people should know, a line at a time
};

// keys: what is stored in the results file's campaign table besides the environment. True: all runs of the shard are in
// the file; false: it was stopped. Throws LoadError, ReferenceError, FileLockError, ResultsFileError,
// ImageError.
bool runCampaign(const CampaignSettings& settings, const std::map<std::string, std::string>& keys,
                 const CampaignHooks& hooks);

}  // namespace wavecrest
