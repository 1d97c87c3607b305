// What a campaign is to do, as plain data, and the profiles that fill it in.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/plan/render_settings.h"

namespace wavecrest {

// A row of a campaign: a method with the choices that make it another one, which its name tells: "mlt-pathspace" is mlt
// with chains in path space, "ppm-direct" ppm with direct light by next event estimation, "ppm-auto" ppm with the
// defaults of `wavecrest render` in place of the campaign's settings.
struct CampaignMethod {
  Method method = Method::pt;
  MetropolisVariant variant = MetropolisVariant::mmlt;
  bool directPass = false;
  bool automatic = false;  // radius, light paths, roulette, merges and sampler are the defaults of `render`

  std::string name() const;
  bool operator==(const CampaignMethod&) const = default;
};

// Render time of each run of a scene, and when its snapshots are taken.
struct Effort {
  double seconds = 0;
  double snapshotSeconds = 0;     // 0: at render times of a fixed ratio
  bool logarithmicFirst = false;  // at such times until they are further apart than snapshotSeconds
};

// A named choice of everything. quick and standard are for small images and use the references that come with the
// scenes; study and paper have the study's size, light paths, radius and roulette, paper its run times too.
struct Profile {
  std::string_view name;
  std::array<uint32_t, 2> size;
  unsigned seeds;
  std::span<const CampaignMethod> rows;  // none: one of each method
  uint64_t lightPaths;                   // of methods that merge, in an iteration; 0: one per pixel
  std::optional<double> radius;          // of the first merges; unset: what the image needs
  Roulette roulette;
  MergeVertices mergeVertices;         // of vcm
  std::optional<SamplerKind> sampler;  // unset: the best of each method
  bool balancedWalks;                  // of lt
  Effort (*effort)(std::string_view scene);
};

std::span<const Profile> profiles();
const Profile* findProfile(std::string_view name);

struct CampaignScene {
  std::string name;
  std::string word;  // as commands find it: the name of a built-in scene, or a path
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
  std::string leftOut;  // which of the nine are not among the scenes by default, and why; or nothing
  std::vector<CampaignMethod> methods;
  unsigned seeds = 1;                  // 1, 2, ...
  std::optional<uint64_t> iterations;  // of each run, with snapshots after 1, 2, 4, ...; else the scenes' efforts
  std::array<uint32_t, 2> size{};
  RenderSettings render;                           // threads, clock, precision, ISA, radius, light paths of every run
  std::optional<SamplerKind> sampler;              // of every run; unset: the best of its method
  std::map<std::string, std::string> definitions;  // values of variables; each is of one scene at least
  std::filesystem::path out;                       // folder of everything that is written
  std::filesystem::path referenceFolder;           // of SCENE.exr
  bool referenceRequired = false;                  // a reference that is not there is an error, else it is rendered
  bool keepImages = true;                          // of all snapshots, else of the last of each run
  bool checkpoints = false;                        // write one of each run, from which it and longer runs resume
  Shard shard;
};

// The campaign's results file: DIR/results.sqlite, or of a shard DIR/results.1-of-4.sqlite.
std::filesystem::path resultsFile(const CampaignSettings& settings);

// DIR/checkpoints/SCENE.ROW.SEED.checkpoint; empty where the campaign writes no checkpoints.
std::filesystem::path checkpointFile(const CampaignSettings& settings, const CampaignScene& scene,
                                     const CampaignMethod& row, uint64_t seed);

}  // namespace wavecrest
