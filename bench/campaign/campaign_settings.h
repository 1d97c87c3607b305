// What a campaign is to do, as plain data, and the profiles that fill it in.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/render_settings.h"

namespace wavecrest {

// Render time of each run of a scene, and when its snapshots are taken.
struct Effort {
  double seconds = 0;
  double snapshotSeconds = 0;  // 0: at render times of a fixed ratio
};

// A named choice of everything. quick and standard are for small images and use the references that come with the
// scenes; paper is the protocol of the study.
struct Profile {
  std::string_view name;
  std::string_view description;  // one line
  std::array<uint32_t, 2> size;
  unsigned seeds;
  bool ownReferences;  // renders them itself, if none are given
  Effort (*effort)(std::string_view scene);
};

std::span<const Profile> profiles();
const Profile* findProfile(std::string_view name);

struct CampaignScene {
  std::string name;
  std::filesystem::path file;
  Effort effort;  // unused where iterations are counted
};

// Which part of a campaign this process does: the groups scene x method whose number leaves index - 1 when divided by
// count. All seeds of a method stay together, as its bias takes all of them.
struct Shard {
  unsigned index = 1, count = 1;  // index from 1 to count
};

struct CampaignSettings {
  std::vector<CampaignScene> scenes;
  std::vector<Method> methods;
  unsigned seeds = 1;                  // 1, 2, ...
  std::optional<uint64_t> iterations;  // of each run, with snapshots after 1, 2, 4, ...; else the scenes' efforts
  std::array<uint32_t, 2> size{};
  RenderSettings render;                  // threads, precision, ISA and sampler of every run
  std::filesystem::path out;              // folder of everything that is written
  std::filesystem::path referenceFolder;  // of SCENE.exr
  bool referenceRequired = false;         // a reference that is not there is an error, else it is rendered
  bool keepImages = true;                 // of all snapshots, else of the last of each run
  Shard shard;
};

// The campaign's results file: DIR/results.sqlite, or of a shard DIR/results.1-of-4.sqlite.
std::filesystem::path resultsFile(const CampaignSettings& settings);

}  // namespace wavecrest
