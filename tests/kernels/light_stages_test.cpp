// The stages of light walks, and of what joins them with camera paths, against their scalar twin: as stages_test.cpp
// does for camera paths, for counts that leave every possible tail, with poison past the size of each queue.
#include <gtest/gtest.h>

#include <functional>

#include "kernels/columns/light_vertices.h"
#include "tests/kernels/stage_room.h"
#include "tests/kernels/stage_waves.h"

namespace wavecrest {
namespace {

constexpr size_t kWalks = 192;

// What only t = 1 reads of a camera.
void completeCamera(CameraView& camera) {
  const auto vec = [](const double(&a)[3]) { return D3{a[0], a[1], a[2]}; };
  D3 axis = normalized(cross(vec(camera.du), vec(camera.dv)));
  if (dot(axis, vec(camera.corner)) < 0) axis = axis * -1.0;
  for (size_t i = 0; i < 3; ++i) camera.axis[i] = axis[i];
  camera.planeDepth = dot(vec(camera.corner), axis);
  camera.inverseDu2 = 1 / dot(vec(camera.du), vec(camera.du));
  camera.inverseDv2 = 1 / dot(vec(camera.dv), vec(camera.dv));
  camera.pixelDistance = camera.planeDepth * std::sqrt(camera.inverseDu2);
}

// A wave and the light vertices of its paths.
template <class S>
struct LightState {
  Wave<S> wave;
  LightStore<S> store;
  explicit LightState(const ColumnNeeds& needs) : wave(kWalks, needs), store(kWalks, needs, {}) {}
};

template <class S>
struct LightCase {
  const char* name;
  uint32_t depth;
  Stage<S> Stages<S>::*stage;
  Walk walk = Walk::light;
  double ulps = 256;
};

template <class S>
std::vector<LightCase<S>> lightStages() {
  using T = Stages<S>;
  // Depth 4 has roulette.
  return {{"generate light", 0, &T::generateLightPaths},
          {"arrive 1", 1, &T::arrive},
          {"arrive 3", 3, &T::arrive},
          {"store 1", 1, &T::storeLightVertices},
          {"store 2", 2, &T::storeLightVertices},
          {"connect to camera 1", 1, &T::connectToCamera},
          {"connect to camera 2", 2, &T::connectToCamera},
          {"scatter 1", 1, &T::scatter},
          {"scatter 4", 4, &T::scatter},
          {"connect vertices 1", 1, &T::connectVertices, Walk::camera, 4096},
          {"connect vertices 2", 2, &T::connectVertices, Walk::camera, 4096}};
}

template <class S>
class LightComparison {
 public:
  LightComparison(Isa isa, Precision precision, Specialization specialization)
      : scene_(makeRoom<S>(covers(specialization, kCurvedShapes), covers(specialization, kSpecularBsdfs),
                           covers(specialization, kNormalMaps))),
        twin_(findStages<S>(Isa::scalar, precision, specialization)),
        stages_(findStages<S>(isa, precision, specialization)),
        needs_(columnNeedsOf(specialization)) {
    completeCamera(scene_.view.camera);
    context_.scene = &scene_.view;
    context_.pixels = scene_.pixels.data();
    context_.sampler = {.kind = SamplerKind::independent, .seed = 11, .iteration = 3};
    context_.limits = {.maxDepth = 7, .rouletteDepth = 4};
    context_.film = {0, 0, scene_.view.camera.width, scene_.view.camera.height};
    context_.mis = {.connect = true, .camera = true, .lightPaths = kWalks};
  }

  void compare(const LightCase<S>& stage) {
    LightState<S> input(needs_), expected(needs_), actual(needs_);
    carryTo(stage, input);
    ColumnScales scales;
    for (size_t count = 2 * stages_.lanes + 1; count <= 2 * stages_.lanes + 1; --count) {
      if (stage.depth == 0 && count == 0) continue;  // a wave has at least one path
      const StageCounters want = run(twin_, stage, input, expected, count);
      if (scales.empty()) scales = columnScales(expected.wave);  // of the most items
      const StageCounters got = run(stages_, stage, input, actual, count);
      const std::string where = std::string(stage.name) + ", " + std::to_string(count) + " items";
      EXPECT_EQ(want.lightVertices, got.lightVertices) << where;
      EXPECT_EQ(want.connections, got.connections) << where;
      EXPECT_EQ(want.misses, got.misses) << where;
      expectSameWave(expected.wave, actual.wave, scales, stage.ulps, where);
      expectSameVertices(expected.store, actual.store, where);
    }
  }

 private:
  using T = Stages<S>;

  void call(Stage<S> stage, LightState<S>& state, StageCounters& counters) {
    context_.counters = &counters;
    context_.light.store = &state.store;
    stage(context_, state.wave);
  }
  void step(Stage<S> stage, LightState<S>& state) {
    StageCounters ignored;
    call(stage, state, ignored);
  }

  // The twin's light walk up to a depth's stage, or to its end.
  void walkLight(LightState<S>& state, const LightCase<S>* until) {
    state.wave.pathCount = kWalks;
    state.store.clear();
    context_.walk = Walk::light;
    context_.depth = 0;
    if (until != nullptr && until->depth == 0) return;
    step(twin_.generateLightPaths, state);
    for (context_.depth = 1; context_.depth < 5; ++context_.depth) {
      state.store.beginDepth(state.wave.rays.size);
      for (const auto member :
           {&T::extendSmall, &T::arrive, &T::storeLightVertices, &T::connectToCamera, &T::scatter}) {
        if (until != nullptr && context_.depth == until->depth && member == until->stage) return;
        step(twin_.*member, state);
      }
    }
  }
  void carryTo(const LightCase<S>& stage, LightState<S>& state) {
    if (stage.walk == Walk::light) return walkLight(state, &stage);
    walkLight(state, nullptr);
    context_.walk = Walk::camera;
    context_.depth = 0;
    step(twin_.generateCameraPaths, state);
    for (context_.depth = 1;; ++context_.depth) {
      step(twin_.extendSmall, state);
      step(twin_.arrive, state);
      if (context_.depth == stage.depth) return;
      step(twin_.scatter, state);
    }
  }

  // The stage on the first `count` items of the input, and nothing but poison past them.
  StageCounters run(const Stages<S>& stages, const LightCase<S>& stage, const LightState<S>& input,
                    LightState<S>& state, size_t count) {
    state.wave.copyFrom(input.wave);
    Wave<S>& wave = state.wave;
    if (stage.depth == 0) wave.pathCount = count;
    for (size_t* size : {&wave.rays.size, &wave.paths.size, &wave.hits.size, &wave.surfaces.size, &wave.joinable}) {
      *size = std::min(*size, count);
    }
    wave.diffuse = std::min(wave.diffuse, wave.joinable);
    wave.pairs.size = wave.sortedPairs.size = 0;
    poisonTails(wave);
    copyStore(input.store, state.store, stage);
    context_.walk = stage.walk;
    context_.depth = stage.depth;
    context_.light.repetition = 0;
    StageCounters counters;
    call(stages.*stage.stage, state, counters);
    return counters;
  }

  // The light vertices that the stage finds: those of all lanes, path by path and in the order of their depths.
  void copyStore(const LightStore<S>& from, LightStore<S>& to, const LightCase<S>& stage) {
    std::vector<const LightStore<S>*> stores{&from};
    to.clear();
    if (stage.walk == Walk::camera) {
      to.collect(stores, kWalks, 0, kWalks);
    } else {
      to.beginDepth(kWalks);
    }
  }

  static void expectSameVertices(LightStore<S>& expected, LightStore<S>& actual, const std::string& where) {
    ASSERT_EQ(expected.vertices.size, actual.vertices.size) << where;
    for (size_t i = 0; i < expected.vertices.size; ++i) {
      const VertexRow<S>&want = expected.vertices.row[i], &got = actual.vertices.row[i];
      ASSERT_EQ(expected.vertices.lane[i], actual.vertices.lane[i]) << where << " vertex " << i;
      ASSERT_EQ(expected.vertices.next[i], actual.vertices.next[i]) << where << " vertex " << i;
      ASSERT_EQ(want.dVCM, got.dVCM) << where << " vertex " << i;
      for (size_t k = 0; k < 3; ++k) {
        ASSERT_EQ(want.position[k], got.position[k]) << where << " vertex " << i;
        ASSERT_EQ(want.throughput[k], got.throughput[k]) << where << " vertex " << i;
      }
    }
  }

  StageScene<S> scene_;
  const Stages<S>& twin_;
  const Stages<S>& stages_;
  const ColumnNeeds needs_;
  StageContext<S> context_;
};

class LightStageTest : public testing::TestWithParam<Choice> {
 protected:
  template <class S>
  void compareAll() {
    const Choice& choice = GetParam();
    LightComparison<S> comparison(choice.isa, choice.precision, choice.specialization);
    for (const LightCase<S>& stage : lightStages<S>()) comparison.compare(stage);
  }
};

TEST_P(LightStageTest, equalsScalarTwin) {
  if (GetParam().precision == Precision::doubled) {
    compareAll<double>();
  } else {
    compareAll<float>();
  }
}

std::vector<Choice> bidirectionalChoices() {
  std::vector<Choice> choices = allChoices();
  std::erase_if(choices, [](const Choice& choice) { return !covers(choice.specialization, kBidirectional); });
  return choices;
}
INSTANTIATE_TEST_SUITE_P(Kernels, LightStageTest, testing::ValuesIn(bidirectionalChoices()),
                         [](const auto& instance) { return nameOf(instance.param); });

}  // namespace
}  // namespace wavecrest
