// What a campaign is to do: the options of `wavecrest converge`, with the same names, words and defaults.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace wavecrest::api {

struct CampaignOptions {
  // What the campaign is, by the name of the option: "scenes", "--methods", "--profile", "--time", "--time-factor",
  // "--snapshot-every", "--spp", "--seeds", "--size", "--precision", "--sampler", "--images", "--radius",
  // "--radius-alpha", "--merge-vertices", "--light-paths", "--roulette", "--direct-pass", "--mlt", "--clock", "--crop",
  // "-D"; only what differs from the defaults. "scenes", "--methods", "--mlt", "--crop" and "-D" take several words,
  // the others one; that of "--direct-pass" is "yes". They are stored with the results as given, with the scenes by
  // default, so that going on needs none of them and is refused with others.
  std::map<std::string, std::vector<std::string>> defining{};

  // How it is run; may change from one process to the next.
  std::string out = "out/converge";  // folder of results.sqlite, images, references and report
  std::string reference{};           // folder of SCENE.exr; empty: those that come with the scenes
  std::string shard = "1/1";         // i/n: do only the i-th of n parts
  std::string isa = "auto";
  uint32_t threads = 0;      // 0: as the campaign was begun, or all cores; campaigns by time are not resumed by others
  bool checkpoints = false;  // write one of each run into `out`, from which it and longer runs resume
  bool resume = false;       // go on with the campaign in `out`, if there is one
  bool check = false;        // the findings of the study are to be judged, so the campaign has to be able to
};

}  // namespace wavecrest::api
