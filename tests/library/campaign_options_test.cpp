// Words of a campaign's options that are refused before anything is rendered or stored.
#include "library/campaign_options.h"

#include <gtest/gtest.h>

#include "library/errors.h"
#include "tests/library/refusal.h"

namespace wavecrest {
namespace {

using Words = std::vector<std::string>;

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

}  // namespace
}  // namespace wavecrest
