#include "engine/plan/pipeline.h"

#include <algorithm>

namespace wavecrest {

namespace {

// How many records of the wave a stage of this kind is about to read.
template <class S>
size_t itemsOf(const Wave<S>& wave, StageItems items) {
  switch (items) {
    case StageItems::beginning:
      return wave.pathCount;
    case StageItems::live:
      return wave.rays.size;
    case StageItems::joinable:
      return wave.joinable;
    case StageItems::shadowRays:
      return wave.shadowRays.size;
  }
  return 0;
}

// Turns the steps and phases of a page into calls of compiled kernels.
template <class S>
class Caller {
 public:
  Caller(const MethodPage& page, const Stages<S>& stages, const Intersector<S>& intersector)
      : page_(page), stages_(stages), intersector_(intersector) {}

  // The call of one stage. first: the step is of the list for depth 1. before: the stage in front of it, or the stage
  // itself if there is none. The name of the row depends on both.
  StageCall<S> call(Walk walk, bool first, Step step, StageId before) const {
    const StageInfo& info = infoOf(step.stage);
    StageCall<S> call{rowName(page_, walk, first, step.stage, before),
                      nullptr,
                      items(info.items),
                      info.single ? 1 : stages_.lanes,
                      step.repeat,
                      step.repeat == Repeat::untilJoined && info.items != StageItems::shadowRays};
    // The scene decides which kernels stand for extend and occlude.
    if (step.stage == StageId::extend || step.stage == StageId::occlude) {
      call.run = step.stage == StageId::extend ? intersector_.extend : intersector_.occlude;
      call.lanes = intersector_.lanes;
    } else {
      call.run = stages_.of(step.stage);
    }
    return call;
  }
  template <class List>
  std::vector<StageCall<S>> calls(Walk walk, bool first, const List& steps) const {
    std::vector<StageCall<S>> calls;
    StageId before{};
    for (const Step step : steps) {
      calls.push_back(call(walk, first, step, calls.empty() ? step.stage : before));
      before = step.stage;
    }
    return calls;
  }
  std::vector<StageCall<S>> calls(const OncePhase& phase) const {
    std::vector<Step> steps;
    for (const StageId stage : phase.stages) steps.push_back({stage});
    return calls(phase.walk, false, steps);
  }
  // The pass of a walk. Only connections to the camera make splats.
  Pass<S> pass(const WalkPhase& walk) const {
    return {.walk = walk.walk,
            .strategies = weightsOf(page_, walk.walk),
            .generate = call(walk.walk, false, {walk.generate}, walk.generate),
            .firstDepth = calls(walk.walk, true, walk.first),
            .perDepth = calls(walk.walk, false, walk.steps),
            .stores = walk.steps.has(StageId::storeLightVertices),
            .splats = walk.steps.has(StageId::connectToCamera)};
  }

 private:
  // StageCall::items is a plain function pointer, so each kind of item has its own function.
  static size_t (*items(StageItems kind))(const Wave<S>&) {
    switch (kind) {
      case StageItems::beginning:
        return [](const Wave<S>& wave) { return itemsOf(wave, StageItems::beginning); };
      case StageItems::live:
        return [](const Wave<S>& wave) { return itemsOf(wave, StageItems::live); };
      case StageItems::joinable:
        return [](const Wave<S>& wave) { return itemsOf(wave, StageItems::joinable); };
      case StageItems::shadowRays:
        return [](const Wave<S>& wave) { return itemsOf(wave, StageItems::shadowRays); };
    }
    return nullptr;
  }

  const MethodPage& page_;
  const Stages<S>& stages_;
  const Intersector<S>& intersector_;
};

}  // namespace

template <class S>
const Pass<S>* Stretch<S>::pass(Walk walk) const {
  for (const auto& phase : phases) {
    const auto* const pass = std::get_if<Pass<S>>(&phase);
    if (pass != nullptr && pass->walk == walk) return pass;
  }
  return nullptr;
}

template <class S>
const Pass<S>* Pipeline<S>::pass(Walk walk) const {
  for (const Stretch<S>& stretch : stretches) {
    if (const Pass<S>* const pass = stretch.pass(walk)) return pass;
  }
  return nullptr;
}

template <class S>
bool Pipeline<S>::has(Fold fold) const {
  return std::any_of(stretches.begin(), stretches.end(),
                     [fold](const Stretch<S>& stretch) { return stretch.fold == fold; }) ||
         std::find(lessons.begin(), lessons.end(), fold) != lessons.end();
}

template <class S>
Pipeline<S> makePipeline(const MethodPage& page, const Stages<S>& stages, const Intersector<S>& intersector) {
  const Caller<S> caller(page, stages, intersector);
  Pipeline<S> pipeline;
  pipeline.chains = page.hasChains();
  pipeline.inPathSpace = page.has(StageId::proposePaths);
  pipeline.stretches.emplace_back();
  for (const Phase& phase : page.phases) {
    Stretch<S>& stretch = pipeline.stretches.back();
    if (const auto* walking = std::get_if<WalkPhase>(&phase)) {
      stretch.phases.push_back(caller.pass(*walking));
    } else if (const auto* once = std::get_if<OncePhase>(&phase)) {
      const bool decides = once->stages.front() == StageId::acceptMutations;
      stretch.phases.push_back(OnceCalls<S>{caller.calls(*once), decides, once->ends, once->walk, once->depth});
    } else if (const Fold fold = std::get<Barrier>(phase).fold; isLesson(fold)) {
      pipeline.lessons.push_back(fold);
    } else {
      stretch.fold = fold;
      pipeline.stretches.emplace_back();
    }
  }
  if (!page.directLight.empty()) {
    // Direct light is a page of its own: chains change neither the weights nor the names of its stages.
    const MethodPage direct{{page.directLight.front()}};
    pipeline.directPass = Caller<S>(direct, stages, intersector).pass(page.directLight.front());
  }
  return pipeline;
}
template struct Stretch<float>;
template struct Stretch<double>;
template struct Pipeline<float>;
template struct Pipeline<double>;
template Pipeline<float> makePipeline(const MethodPage&, const Stages<float>&, const Intersector<float>&);
template Pipeline<double> makePipeline(const MethodPage&, const Stages<double>&, const Intersector<double>&);

}  // namespace wavecrest
