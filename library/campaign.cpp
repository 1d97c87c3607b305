// Campaigns of the interface.
#include "wavecrest/campaign.h"

#include <array>
#include <thread>

#include "bench/campaign/run_campaign.h"
#include "bench/report/write_report.h"
#include "bench/results/read_results.h"
#include "engine/version.h"
#include "library/campaign_options.h"
#include "library/stop_watch.h"
#include "library/translate.h"
#include "wavecrest/wavecrest.h"

namespace wavecrest::api {

const char* version() { return kVersion; }
const char* commit() { return kCommit; }

// Counted while it holds a session. Where a signal handler interrupts watch(), it is through before watch() goes on.
void StopRequest::request() noexcept {
  requested_.store(true);
  requesting_.fetch_add(1);
  if (void* const session = session_.load()) static_cast<Session*>(session)->interrupt();
  requesting_.fetch_sub(1);
}

// A request that begins after the store finds the new session. Earlier ones may hold the former, whose owner is about
// to end it, so they are waited for.
void StopWatch::watch(StopRequest& stop, Session* session) noexcept {
  stop.session_.store(session);
  while (stop.requesting_.load() != 0) std::this_thread::yield();
  if (session != nullptr && stop.requested_.load()) session->interrupt();
}

bool converge(const CampaignOptions& options, const CampaignCallbacks& callbacks, StopRequest* stop) {
  return translated([&] {
    CampaignOptions asked = options;
    const CampaignSettings settings = begunCampaign(asked);
    const CampaignHooks hooks{.session = {.watch =
                                              [&](Session* session) {
                                                if (stop != nullptr) StopWatch::watch(*stop, session);
                                              }},
                              .stopped = [&] { return stop != nullptr && stop->requested(); },
                              .planned = [](const CampaignPlan&) {},
                              .finished =
                                  [&](const RunRecord& run, const wavecrest::CampaignProgress& progress) {
                                    if (callbacks.finished)
                                      callbacks.finished(run, {progress.done, progress.total, progress.secondsLeft});
                                  },
                              .say =
                                  [&](const std::string& line) {
                                    if (callbacks.say) callbacks.say(line);
                                  }};
    if (!runCampaign(settings, campaignKeys(asked, settings), hooks)) return false;
    if (settings.shard.count == 1) finishCampaign(settings);
    return true;
  });
}

CampaignResults readResults(const std::string& path) {
  return translated([&] { return wavecrest::readResults(std::filesystem::path(path)); });
}

std::string writeReport(const std::string& folder) {
  return translated(
      [&] { return wavecrest::writeReport(std::array{std::filesystem::path(folder)}).files.front().string(); });
}

}  // namespace wavecrest::api
