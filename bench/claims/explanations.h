// Why findings of the study do not hold, or stay open, in the campaigns that are published (explanations.json): of each
// profile one, named by the commit of its program.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace wavecrest {

struct Explanation {
  std::string profile, commit;  // of the campaign that it was written about
  std::string verdict;          // which it explains
  std::string text;
  std::vector<std::string> claims = {};  // ids, at least one
};

// Throws ClaimListError for another form, for a claim that claims.json does not have, and for a claim with a second
// explanation in one profile.
std::vector<Explanation> parseExplanations(std::string_view json);

const std::vector<Explanation>& studyExplanations();
// Of this verdict, that of the profile; else that of another profile, of which the study's comes first. Null if there
// is none. It may be of another campaign (isOf).
const Explanation* findExplanation(std::string_view claim, std::string_view verdict, std::string_view profile);

// Whether the explanation was written about a campaign of this profile and commit. Of a campaign that went on by other
// programs, commit is the list "a, b" of all.
bool isOf(const Explanation& explanation, std::string_view profile, std::string_view commit);

}  // namespace wavecrest
