// Words of a campaign's options that are refused before anything is rendered or stored, and words that make a campaign
// larger.
#include "library/campaign_options.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>

#include "bench/results/results_store.h"
#include "library/errors.h"
#include "tests/metrics/temporary_folder.h"
#include "tests/refusal.h"

namespace wavecrest {
namespace {

using Words = std::vector<std::string>;
using Defining = std::map<std::string, Words>;

api::CampaignOptions campaignOf(const std::string& option, const Words& words) {
  return {.defining = {{option, words}}, .out = "no-such-folder"};
}

std::string refusalOfCampaign(api::CampaignOptions options) {
  return refusalOf<UsageError>([&] { begunCampaign(options); });
}

TEST(CampaignOptions, severalWordsAreForLists) {
  EXPECT_EQ(refusalOfCampaign(campaignOf("--seeds", {"3", "4"})), "--seeds 3 4: expected one value");
  EXPECT_EQ(refusalOfCampaign(campaignOf("--precision", {"float", "double"})),
            "--precision float double: expected one value");
  for (const auto& [option, words] :
       {std::pair{"scenes", Words{"cornell-diffuse", "cornell-mirror"}}, std::pair{"--methods", Words{"pt", "bpt"}},
        std::pair{"--mlt", Words{"mmlt", "pssmlt"}}, std::pair{"-D", Words{"a=1", "b=2"}}}) {
    api::CampaignOptions options = campaignOf(option, words);
    EXPECT_NO_THROW(begunCampaign(options)) << option;
  }
}

TEST(CampaignOptions, snapshotsAreNoLessThanATenthOfAMillisecondApart) {
  EXPECT_EQ(refusalOfCampaign(campaignOf("--snapshot-every", {"1e-9s"})),
            "--snapshot-every 1e-9s: expected log, or 0.1ms or more");
  api::CampaignOptions options = campaignOf("--snapshot-every", {"0.1ms"});
  EXPECT_NO_THROW(begunCampaign(options));
}

TEST(CampaignOptions, cropsArePartsOfPicturesOfTheCampaign) {
  const auto refusal = [](const std::string& crop) {
    api::CampaignOptions options = campaignOf("--crop", {"cornell-diffuse:1,2,3x4", crop});
    options.defining["scenes"] = {"cornell-diffuse"};
    options.defining["--size"] = {"64x48"};
    return refusalOfCampaign(options);
  };
  for (const char* word : {"1,2,3x4", "cornell-diffuse:1,2,3", "cornell-diffuse:1,2,0x4", ":1,2,3x4"}) {
    EXPECT_EQ(refusal(word),
              std::string("--crop ") + word + ": expected SCENE:X,Y,WIDTHxHEIGHT in pixels from the top left");
  }
  EXPECT_EQ(refusal("cornell-mirror:1,2,3x4"),
            "--crop cornell-mirror:1,2,3x4: the campaign has no such scene; expected one of its own");
  for (const char* word :
       {"cornell-diffuse:60,0,5x1", "cornell-diffuse:0,47,1x2", "cornell-diffuse:4294967295,0,9x9"}) {
    EXPECT_EQ(refusal(word), std::string("--crop ") + word + ": images have 64x48 pixels; expected a part of them");
  }
  api::CampaignOptions options = campaignOf("--crop", {"cornell-diffuse:60,44,4x4", "cornell-mirror:0,0,256x192"});
  options.defining["scenes"] = {"cornell-diffuse", "cornell-mirror"};
  EXPECT_NO_THROW(begunCampaign(options));
}

TEST(CampaignOptions, aDirectPassIsGivenByYesAlone) {
  EXPECT_EQ(refusalOfCampaign(campaignOf("--direct-pass", {"False"})),
            "--direct-pass False: expected yes, or no such option");
  api::CampaignOptions options = campaignOf("--direct-pass", {"yes"});
  EXPECT_NO_THROW(begunCampaign(options));
}

TEST(CampaignOptions, threadsHaveTheRangeOfTheCommandLine) {
  EXPECT_EQ(refusalOfCampaign({.out = "no-such-folder", .threads = 4097}),
            "--threads 4097: expected a number from 1 to 4096");
}

// What a campaign that was begun with some options has once it is resumed with others.
CampaignSettings resumed(const Defining& begun, const Defining& added) {
  const test::TemporaryFolder folder;
  const api::CampaignOptions first{.defining = begun, .out = folder.folder().string()};
  const CampaignSettings settings = campaignSettings(first);
  ResultsStore(resultsFile(settings)).putCampaign(campaignKeys(first, settings));
  api::CampaignOptions options{.defining = added, .out = first.out, .resume = true};
  return begunCampaign(options);
}

TEST(CampaignOptions, aSceneIsAddedToThoseByDefaultWhichMayLackTheDragon) {
  const test::TemporaryFolder scenes;
  setenv("WAVECREST_SCENES", scenes.folder().c_str(), 1);
  const CampaignSettings settings = resumed({}, {{"scenes", {"mine.xml"}}});
  unsetenv("WAVECREST_SCENES");
  Words words;
  for (const CampaignScene& scene : settings.scenes) words.push_back(scene.word);
  EXPECT_EQ(words, (Words{"cornell-diffuse", "cornell-mirror", "cornell-glossy", "cornell-spheres", "lafortune-room",
                          "pool-interior", "veach-door", "mine.xml"}));
}

TEST(CampaignOptions, scenesByDefaultAreThoseOfTheBeginningAlsoWhereTheDragonHasBeenFetchedSince) {
  const test::TemporaryFolder scenes, folder;
  setenv("WAVECREST_SCENES", scenes.folder().c_str(), 1);
  const api::CampaignOptions first{.out = folder.folder().string()};
  const CampaignSettings begun = campaignSettings(first);
  ResultsStore(resultsFile(begun)).putCampaign(campaignKeys(first, begun));
  std::filesystem::create_directory(scenes.folder() / "assets");
  scenes.write("assets/dragon_res2.ply", "");
  api::CampaignOptions again{.out = first.out, .resume = true};
  const CampaignSettings settings = begunCampaign(again);
  EXPECT_EQ(campaignSettings(first).scenes.size(), 9u) << "or the dragon is not found";
  unsetenv("WAVECREST_SCENES");
  EXPECT_EQ(begun.scenes.size(), 7u);
  EXPECT_EQ(settings.scenes.size(), 7u);
}

// The command that extended a campaign is given again after a kill.
TEST(CampaignOptions, whatACampaignHasMayBeGivenAgain) {
  const Defining begun = {{"scenes", {"cornell-diffuse", "cornell-mirror"}}, {"--methods", {"pt", "lt"}}};
  const CampaignSettings settings = resumed(
      begun, {{"scenes", {"cornell-mirror"}}, {"--methods", {"lt"}}, {"--seeds", {"2"}}, {"--images", {"all"}}});
  EXPECT_EQ(settings.scenes.size(), 2u);
  EXPECT_EQ(settings.methods.size(), 2u);
  EXPECT_EQ(settings.seeds, 2u);
  EXPECT_TRUE(settings.keepImages);
}

TEST(CampaignOptions, whatACampaignHasByDefaultMayBeSaid) {
  const Defining begun = {{"scenes", {"cornell-diffuse"}}};
  EXPECT_NO_THROW(resumed(begun, {{"--profile", {"quick"}}, {"--precision", {"float"}}}));
  EXPECT_THROW(resumed(begun, {{"--precision", {"double"}}}), UsageError);
}

// The default radius of a profile may have changed since the campaign began.
TEST(CampaignOptions, whatTheProfileChoseWhenTheCampaignBeganMayBeSaid) {
  const test::TemporaryFolder folder;
  const api::CampaignOptions first{.defining = {{"scenes", {"cornell-diffuse"}}, {"--methods", {"vcm"}}},
                                   .out = folder.folder().string()};
  const CampaignSettings begun = campaignSettings(first);
  std::map<std::string, std::string> keys = campaignKeys(first, begun);
  keys["radius"] = "0.002";
  ResultsStore(resultsFile(begun)).putCampaign(keys);
  api::CampaignOptions same{.defining = {{"--radius", {"0.002"}}}, .out = first.out, .resume = true};
  EXPECT_EQ(begunCampaign(same).render.radius, 0.002);
  api::CampaignOptions other{.defining = {{"--radius", {"0.003"}}}, .out = first.out, .resume = true};
  EXPECT_THROW(begunCampaign(other), UsageError);
}

// Size and scenes come from the results file.
TEST(CampaignOptions, aCropOfTheCampaignMayBeGivenAgainAlone) {
  for (const char* scene : {"cornell-diffuse", "mine"}) {
    const Defining crop = {{"--crop", {std::string(scene) + ":300,300,50x50"}}};
    Defining begun = crop;
    begun["--size"] = {"512x384"};
    begun["scenes"] = {std::string(scene) == "mine" ? "mine.xml" : scene};
    EXPECT_EQ(resumed(begun, crop).size, (std::array<uint32_t, 2>{512, 384})) << scene;
  }
}

TEST(CampaignOptions, whereVcmMergesIsForTheMethodsThatHaveTheChoice) {
  api::CampaignOptions options = campaignOf("--merge-vertices", {"all"});
  options.defining["--methods"] = {"ppm"};
  EXPECT_EQ(refusalOfCampaign(options),
            "--merge-vertices: no method of the campaign has the choice; expected vcm or evcm among --methods");
  options.defining["--methods"] = {"evcm"};
  EXPECT_NO_THROW(begunCampaign(options));
}

TEST(CampaignOptions, aMethodIsAddedToTheProfilesWithTheVariantsOfMltThatWereAskedFor) {
  const CampaignSettings settings =
      resumed({{"--profile", {"standard"}}, {"--mlt", {"pssmlt"}}}, {{"--methods", {"gpt"}}});
  Words names;
  for (const CampaignMethod& row : settings.methods) names.push_back(row.name());
  EXPECT_EQ(names, (Words{"pt", "lt", "bpt", "mlt-pssmlt", "ppm", "ppm-direct", "bpm", "vcm", "gpt"}));
}

}  // namespace
}  // namespace wavecrest
