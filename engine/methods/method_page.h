// How a method is written: one page, a list of phases that name stages of the catalogue (kernels/stage_catalogue.h).
//
// A page is plain data. What follows from it is computed once, here: which strategies the method has and how they are
// weighted, whether it needs kernels with light paths, and the names of its rows in --stats. engine/plan/pipeline.h
// turns it into calls of compiled kernels.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <variant>
#include <vector>

#include "kernels/stages.h"

namespace wavecrest {

// How often a stage runs at each depth of its walk. Neighbouring stages with untilJoined are repeated together until
// all pairs of vertices have been joined.
enum class Repeat { once, untilJoined };

struct Step {
  StageId stage;
  Repeat repeat = Repeat::once;
};

// `untilJoined{connectVertices, occlude}` in a list of steps.
struct untilJoined {  // NOLINT(readability-identifier-naming): reads as a word of the page
  std::vector<StageId> stages;
  untilJoined(std::initializer_list<StageId> list) : stages(list) {}
};

class Steps {
 public:
  struct Entry {
    std::vector<Step> steps;
    Entry(StageId stage) : steps{{stage}} {}
    Entry(const untilJoined& group) {
      for (const StageId stage : group.stages) steps.push_back({stage, Repeat::untilJoined});
    }
  };
  Steps() = default;
  Steps(std::initializer_list<Entry> entries) {
    for (const Entry& entry : entries) steps_.insert(steps_.end(), entry.steps.begin(), entry.steps.end());
  }
  auto begin() const { return steps_.begin(); }
  auto end() const { return steps_.end(); }
  bool empty() const { return steps_.empty(); }
  size_t size() const { return steps_.size(); }
  bool has(StageId stage) const;

 private:
  std::vector<Step> steps_;
};

// Paths are generated once and go depth by depth through the steps until none is left. first: at depth 1, where it
// differs.
struct WalkPhase {
  Walk walk = Walk::camera;
  StageId generate{};
  Steps steps = {};
  Steps first = {};
};

// A barrier: all waves of an iteration have been through the phases before it when those after it begin. In between it
// folds: it turns what the phases before it gathered into what those behind it read. photonMap: the light vertices of
// the iteration into its photon map.
//
// A lesson is a barrier at the end of a block of iterations (engine/learn/blocks.h), behind the page's last phase: what
// all iterations of the block gathered becomes what those of the next read. guide: directions in which paths found
// light into the histograms that directions are drawn from.
enum class Fold { photonMap, guide };
constexpr bool isLesson(Fold fold) { return fold != Fold::photonMap; }
struct Barrier {
  Fold fold{};
};

// Where the stages that join the walks of multiplexed chains work: kernels/columns/chains.h, WalkEnds. `wave`: on the
// wave itself.
enum class EndsOf { wave, atOrigin, cameraAtVertex, lightAtVertex };

// Stages that run once, not depth by depth. ends: of a method that joins the ends of walks, of all depths together;
// the stages take them for those of this walk and depth.
struct OncePhase {
  std::vector<StageId> stages;
  EndsOf ends = EndsOf::wave;
  Walk walk = Walk::camera;
  uint32_t depth = 0;
};

using Phase = std::variant<WalkPhase, Barrier, OncePhase>;

struct MethodPage {
  std::vector<Phase> phases;
  // Metropolis: the walk that makes direct light, where the chains may leave it out.
  std::vector<WalkPhase> directLight = {};
  // Beside connections: camera paths merge at the first vertex at which they can, and nowhere else.
  bool firstMerges = false;

  const WalkPhase* walk(Walk walk) const;  // null if there is none
  bool has(StageId stage) const;           // in any phase
  bool has(Fold fold) const;               // at a barrier
  bool hasChains() const { return has(StageId::acceptMutations); }
};

inline WalkPhase walk(Walk walk, StageId generate, Steps steps) { return {walk, generate, std::move(steps)}; }
inline WalkPhase walk(Walk walk, StageId generate, Steps first, Steps steps) {
  return {walk, generate, std::move(steps), std::move(first)};
}
inline Barrier buildPhotonMap() { return {Fold::photonMap}; }
inline Barrier learn(Fold lesson) { return {lesson}; }
inline OncePhase once(std::vector<StageId> stages) { return {std::move(stages)}; }
inline OncePhase atEnds(EndsOf ends, Walk walk, uint32_t depth, std::vector<StageId> stages) {
  return {std::move(stages), ends, walk, depth};
}

// ---- what follows from a page ---------------------------------------------------------------------------------------

// The ways in which a method joins s light vertices and t camera vertices. engine/inspect/path_classes.h derives from
// them which paths the method can make.
struct PathStrategies {
  bool emission = false;            // s = 0: a camera path meets a light
  bool nextEvent = false;           // s = 1
  bool connect = false;             // s >= 2, t >= 2
  bool camera = false;              // t = 1
  bool merge = false;               // without nextEvent, emission then serves the paths that have no vertex to merge at
  bool specularViewsOnly = false;   // emission and nextEvent serve only what a delta lobe, or nothing, shows to the eye
  bool mergeAtFirstVertex = false;  // merges where a camera path first has more than delta lobes, and nowhere else
  bool operator==(const PathStrategies&) const = default;
};
PathStrategies strategiesOf(const MethodPage& page);

// The switches of the weights on this walk: all strategies that make the same paths. The constants of an iteration are
// filled in by misSettings (engine/plan/render_plan.h).
MisSettings weightsOf(const MethodPage& page, Walk walk);

// Whether it needs kernels with the whole MIS recursion: it lists a stage that only those have.
bool isBidirectional(const MethodPage& page);

// The name of a step in --stats: the stage's title, and the walk, depth or purpose where the title alone is not unique.
// before: the stage before it, or the step itself if it is the first.
std::string rowName(const MethodPage& page, Walk walk, bool first, StageId stage, StageId before);

}  // namespace wavecrest
