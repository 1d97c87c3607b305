// The profiles say what they promise: the protocol of the study, and shards with files of their own.
#include "bench/campaign/campaign_settings.h"

#include <gtest/gtest.h>

#include "scenes/scene_list.h"

namespace wavecrest {
namespace {

TEST(Profiles, paperIsTheProtocolOfTheStudy) {
  const Profile& paper = *findProfile("paper");
  EXPECT_EQ(paper.size, (std::array<uint32_t, 2>{1024, 768}));
  const auto minutes = [&](const char* scene) { return paper.effort(scene).seconds / 60; };
  for (const char* scene : {"cornell-diffuse", "cornell-mirror", "cornell-glossy"}) {
    EXPECT_EQ(minutes(scene), 30) << scene;
    EXPECT_EQ(paper.effort(scene).snapshotSeconds, 6) << scene;
  }
  for (const char* scene : {"cornell-spheres", "lafortune-room", "pool-interior"})
    EXPECT_EQ(minutes(scene), 60) << scene;
  for (const char* scene : {"dragon-caustics", "dragon-caustics-glossy", "veach-door"}) {
    EXPECT_EQ(minutes(scene), 120) << scene;
    EXPECT_EQ(paper.effort(scene).snapshotSeconds, 20) << scene;
  }
}

// Runs are as long as findings need paths.
TEST(Profiles, studyHasItsSizeLightPathsAndTimeForItsFindings) {
  const Profile& study = *findProfile("study");
  EXPECT_EQ(study.size, (std::array<uint32_t, 2>{1024, 768}));
  EXPECT_EQ(study.lightPaths, 1024u * 768u);
  EXPECT_EQ(study.effort("cornell-mirror").seconds, 6 * 60);
  EXPECT_EQ(study.effort("cornell-spheres").seconds, 12 * 60);
  EXPECT_EQ(study.effort("lafortune-room").seconds, 29 * 60);
  EXPECT_EQ(study.effort("pool-interior").seconds, 24 * 60);
  EXPECT_EQ(study.effort("dragon-caustics-glossy").seconds, 16 * 60);
  EXPECT_EQ(study.effort("veach-door").seconds, 53 * 60);
  EXPECT_EQ(study.effort("a-scene-of-others").seconds, 12 * 60);
  EXPECT_TRUE(study.effort("veach-door").logarithmicFirst);
  EXPECT_EQ(findProfile("standard")->lightPaths, study.lightPaths);
}

TEST(Rows, areNamedByTheirChoices) {
  EXPECT_EQ((CampaignMethod{.method = Method::mlt}).name(), "mlt");
  EXPECT_EQ((CampaignMethod{.method = Method::mlt, .variant = MetropolisVariant::pathspace}).name(), "mlt-pathspace");
  EXPECT_EQ((CampaignMethod{.method = Method::ppm, .directPass = true}).name(), "ppm-direct");
  EXPECT_EQ((CampaignMethod{.method = Method::vcm, .automatic = true}).name(), "vcm-auto");
}

// The study's six methods as it had them, ppm in both readings, and the best of today.
TEST(Rows, ofTheStudyAreItsMethodsAndTodays) {
  std::string names;
  for (const CampaignMethod& row : findProfile("study")->rows) names += row.name() + " ";
  EXPECT_EQ(names, "pt lt bpt mlt-pathspace ppm ppm-direct vcm ppm-auto bpm-auto vcm-auto mlt gpt-auto evcm-auto ");
}

TEST(Profiles, quickRendersTenMinutesAndStandardAnHourOrTwo) {
  const auto seconds = [](const Profile& profile) {
    const size_t methods = profile.rows.empty() ? kMethods.size() : profile.rows.size();
    double sum = 0;
    for (const SceneEntry& scene : builtInScenes()) {
      sum += static_cast<double>(methods) * profile.seeds * profile.effort(scene.name).seconds;
    }
    return sum;
  };
  EXPECT_LE(seconds(*findProfile("quick")), 600);
  EXPECT_GE(seconds(*findProfile("standard")), 3600);
  EXPECT_LE(seconds(*findProfile("standard")), 7500);
  EXPECT_NEAR(seconds(*findProfile("study")), 41.6 * 3600, 1800);
  EXPECT_GE(findProfile("quick")->seeds, 2u) << "one seed has no error band";
}

TEST(Profiles, unknownNamesAreNone) { EXPECT_EQ(findProfile("quickly"), nullptr); }

TEST(ResultsFile, shardsHaveFilesOfTheirOwn) {
  CampaignSettings settings;
  settings.out = "out";
  EXPECT_EQ(resultsFile(settings), "out/results.sqlite");
  settings.shard = {2, 4};
  EXPECT_EQ(resultsFile(settings), "out/results.2-of-4.sqlite");
}

}  // namespace
}  // namespace wavecrest
