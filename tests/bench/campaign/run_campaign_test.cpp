// A campaign that is stopped keeps all runs that were over by then.
#include "bench/campaign/run_campaign.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "bench/results/read_results.h"
#include "scenes/scene_list.h"
#include "tests/metrics/temporary_folder.h"

namespace wavecrest {
namespace {

TEST(RunCampaign, aRunThatIsOverIsStoredWhereAStopComesBeforeItIsMeasured) {
  const test::TemporaryFolder folder;
  CampaignSettings settings;
  settings.scenes.push_back(
      {.name = "cornell-diffuse", .word = "cornell-diffuse", .file = findScene("cornell-diffuse"), .effort = {}});
  settings.methods.emplace_back();
  settings.iterations = 1;
  settings.size = {16, 12};
  settings.render.isa = bestIsa();
  settings.render.threads = 2;
  settings.out = folder.folder();
  settings.referenceFolder = folder.folder() / "none";
  // The first run, and the reference.
  bool stopped = false;
  CampaignHooks hooks{.session = {},
                      .stopped = [&] { return stopped; },
                      .planned = {},
                      .finished = {},
                      .say = [](const std::string&) {}};
  ASSERT_TRUE(runCampaign(settings, {}, hooks));
  // The campaign is to stop once the second run of three is rendered.
  settings.seeds = 3;
  hooks.session.watch = [&](Session* session) { stopped = session == nullptr; };
  EXPECT_FALSE(runCampaign(settings, {}, hooks));
  EXPECT_EQ(readResults(resultsFile(settings)).runs.size(), 2u);
  for (const auto& entry : std::filesystem::directory_iterator(folder.folder() / "images")) {
    EXPECT_FALSE(entry.path().filename().string().starts_with("unfinished.")) << entry.path();
  }
}

}  // namespace
}  // namespace wavecrest
