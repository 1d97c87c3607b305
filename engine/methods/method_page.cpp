#include "engine/methods/method_page.h"

#include <algorithm>

namespace wavecrest {
namespace {

// Calls visit(walk, stage) for every stage of the page.
template <class Visit>
void forEachStage(const MethodPage& page, const Visit& visit) {
  for (const Phase& phase : page.phases) {
    if (const auto* walking = std::get_if<WalkPhase>(&phase)) {
      visit(walking->walk, walking->generate);
      for (const Step& step : walking->first) visit(walking->walk, step.stage);
      for (const Step& step : walking->steps) visit(walking->walk, step.stage);
    } else if (const auto* single = std::get_if<OncePhase>(&phase)) {
      for (const StageId stage : single->stages) visit(single->walk, stage);
    }
  }
}

// Whether the camera walk goes on from its first vertex only by delta lobes. Then no path of it is also one of the
// light walk.
bool showsSpecularViewsOnly(const WalkPhase& camera) { return camera.first.has(StageId::scatterSpecular); }

}  // namespace

bool Steps::has(StageId stage) const {
  return std::any_of(begin(), end(), [stage](const Step& step) { return step.stage == stage; });
}

const WalkPhase* MethodPage::walk(Walk wanted) const {
  for (const Phase& phase : phases) {
    const auto* walking = std::get_if<WalkPhase>(&phase);
    if (walking != nullptr && walking->walk == wanted) return walking;
  }
  return nullptr;
}

bool MethodPage::has(StageId stage) const {
  bool found = false;
  forEachStage(*this, [&](Walk, StageId listed) { found |= listed == stage; });
  return found;
}

bool MethodPage::has(Fold fold) const {
  return std::any_of(phases.begin(), phases.end(), [fold](const Phase& phase) {
    const auto* barrier = std::get_if<Barrier>(&phase);
    return barrier != nullptr && barrier->fold == fold;
  });
}

PathStrategies strategiesOf(const MethodPage& page) {
  const WalkPhase* const camera = page.walk(Walk::camera);
  // The stage `arrive` adds the emission that a path meets.
  return {.emission = camera != nullptr && camera->steps.has(StageId::arrive),
          .nextEvent = page.has(StageId::nextEvent),
          .connect = page.has(StageId::connectVertices),
          .camera = page.has(StageId::connectToCamera),
          .merge = page.has(StageId::merge),
          .specularViewsOnly = camera != nullptr && showsSpecularViewsOnly(*camera),
          .mergeAtFirstVertex =
              camera != nullptr && camera->steps.has(StageId::merge) && camera->steps.has(StageId::scatterSpecular)};
}

MisSettings weightsOf(const MethodPage& page, Walk walk) {
  // Which strategies make the paths of this walk.
  const PathStrategies all = strategiesOf(page);
  const bool alone = all.specularViewsOnly;  // each walk makes its own paths
  const bool ofCamera = !alone || walk == Walk::camera, ofLight = !alone || walk == Walk::light;
  // Chains in path space weigh whole paths: their walks know no strategies.
  const bool recorded = page.has(StageId::recordPathVertices);
  // Emission is weighted only where another strategy makes the same paths. With mergeAtFirstVertex, camera paths go on
  // by delta lobes alone and meet no light that next event estimation could have sampled. Merging without next event
  // estimation makes all paths that have a vertex to merge at, and emission makes the others.
  const bool mergingAlone = all.merge && !all.nextEvent;
  MisSettings weights;
  weights.emission = ofCamera && all.emission && !mergingAlone && !all.mergeAtFirstVertex && !recorded;
  weights.nextEvent = ofCamera && all.nextEvent;
  weights.connect = all.connect;
  weights.camera = ofLight && all.camera;
  weights.merge = all.merge;
  weights.mergeWeights = !all.mergeAtFirstVertex;
  weights.firstMerges = page.firstMerges;
  // The power heuristic is for two strategies.
  weights.powerHeuristic = weights.nextEvent && !weights.connect && !weights.camera && !weights.merge;
  return weights;
}

bool isBidirectional(const MethodPage& page) {
  bool found = false;
  forEachStage(page, [&](Walk, StageId stage) { found |= infoOf(stage).family == StageFamily::bidirectional; });
  return found;
}

std::string rowName(const MethodPage& page, Walk walk, bool first, StageId stage, StageId before) {
  const std::string_view title = infoOf(stage).title;
  std::string name(title);
  // The stage's title, and what makes it unique: the connections, the first depth, the light walk.
  if (stage == StageId::occlude && before == StageId::connectVertices) return name + " connection";
  if (first && page.walk(walk)->steps.has(stage)) name += " first";
  bool onCamera = false;
  forEachStage(page,
               [&](Walk other, StageId listed) { onCamera |= other == Walk::camera && infoOf(listed).title == title; });
  if (walk == Walk::light && onCamera) name += " light";
  return name;
}

}  // namespace wavecrest
