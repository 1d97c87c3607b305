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
