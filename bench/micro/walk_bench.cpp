// Time of each stage per item, on waves of a real render (Cornell box, box filter), for every instruction set,
// precision policy and several wave sizes. Names read STAGE/ISA/PRECISION/wave:PATHS/depth:VERTEX; Embree's stages have
// packet:WIDTH in place of the instruction set.
//
// Before a stage is timed, its result is compared with that of the scalar twin on the same wave (Embree's with the
// scalar small-scene intersector): a wrong result is an error, not a time. The input wave is restored before each run,
// outside the measured time; it is in the cache then, as it is in a render. Times are CPU time of one thread.
#include <benchmark/benchmark.h>

#include <fmt/core.h>

#include <map>
#include <memory>
#include <string_view>

#include "bench/machine/cpu_timer.h"
#include "bench/micro/registration.h"
#include "bench/micro/wave_agreement.h"
#include "bench/throughput/wave_capture.h"
#include "engine/load/load.h"
#include "scenes/scene_list.h"

namespace wavecrest {
namespace {

// Lanes that may take another turn than the scalar twin's. Measured: below 1e-3 for float against float.
constexpr double kAllowedOnWalks = 4e-3;

constexpr uint32_t kFirstDepth = 1, kLaterDepth = 3;  // camera rays are coherent, later ones are not
constexpr size_t kUsualWave = 2048;

const Scene& cornellBox() {
  static const Scene scene = [] {
    Scene loaded = loadScene(sceneFolder() / "mitsuba-cornell-box.xml");
    loaded.film.filter = ReconstructionFilter::box;  // as in the measurements that it is compared with
    return loaded;
  }();
  return scene;
}

template <class S>
struct StageUnderTest {
  std::string name;          // as reported
  std::string pipelineName;  // as in the pipeline it is taken from
  Stage<S> run, twin;
  double tolerance;
};

// The scene in every form, so that all intersectors can be called on one context.
template <class S>
struct Source {
  WaveCapture<S> small, bvh, embree;
  Source(Precision precision, size_t waveSize)
      : small(cornellBox(), settings(precision, waveSize, Accel::small)),
        bvh(cornellBox(), settings(precision, waveSize, Accel::bvh)),
        embree(cornellBox(), settings(precision, waveSize, Accel::embree)) {
    small.plan().view.bvh = bvh.plan().view.bvh;
    small.plan().view.embree = embree.plan().view.embree;
  }
  static RenderSettings settings(Precision precision, size_t waveSize, Accel accel) {
    RenderSettings settings;
    settings.precision = precision;
    settings.isa = bestIsa();
    settings.accel = accel;
    settings.waveSize = static_cast<uint32_t>(waveSize);
    return settings;
  }
  static Source& of(Precision precision, size_t waveSize) {
    static std::map<std::pair<Precision, size_t>, std::unique_ptr<Source>> cache;
    auto& entry = cache[{precision, waveSize}];
    if (!entry) entry = std::make_unique<Source>(precision, waveSize);
    return *entry;
  }
};

template <class S>
size_t itemsOf(const Wave<S>& wave, const std::string& pipelineName) {
  if (pipelineName == "generate") return wave.pathCount;
  return pipelineName == "occlude" ? wave.shadowRays.size : wave.rays.size;
}

template <class S>
void measure(benchmark::State& state, const StageUnderTest<S>& stage, Precision precision, size_t waveSize,
             uint32_t depth) {
  Source<S>& source = Source<S>::of(precision, waveSize);
  const Wave<S> input = source.small.before(stage.pipelineName, depth);
  const StageContext<S> context = source.small.context(depth);
  Wave<S> expected = source.small.makeWave(), wave = source.small.makeWave();
  expected.copyFrom(input);
  wave.copyFrom(input);
  stage.twin(context, expected);
  stage.run(context, wave);
  const Agreement agreement = compareWaves(expected, wave, stage.tolerance);
  if (agreement.differingFraction() > kAllowedOnWalks) {
    state.SkipWithError(
        fmt::format("{} of {} paths differ from the scalar twin", agreement.differing, agreement.items).c_str());
    return;
  }

  CpuTimer timer;
  for (auto _ : state) {
    wave.copyFrom(input);
    timer.start();
    stage.run(context, wave);
    state.SetIterationTime(timer.seconds());
  }
  reportItems(state, itemsOf(input, stage.pipelineName));
}

template <class S>
void registerStage(const StageUnderTest<S>& stage, Precision precision, size_t waveSize, uint32_t depth) {
  const std::string name = fmt::format("{}/{}/wave:{}/depth:{}", stage.name,
                                       kPrecisionNames[static_cast<size_t>(precision)], waveSize, depth);
  registerBenchmark(name, [=](benchmark::State& state) { measure<S>(state, stage, precision, waveSize, depth); });
}

// Every stage at the usual wave size, for coherent and incoherent paths; the other sizes once.
template <class S>
void registerShapes(const StageUnderTest<S>& stage, Precision precision) {
  if (stage.pipelineName == "generate") {
    for (const size_t size : {size_t{256}, kUsualWave, size_t{16384}}) registerStage(stage, precision, size, 0);
    return;
  }
  registerStage(stage, precision, kUsualWave, kFirstDepth);
  for (const size_t size : {size_t{256}, kUsualWave, size_t{16384}}) registerStage(stage, precision, size, kLaterDepth);
}

struct LaneStage {
  const char* name;
  const char* pipelineName;
};

// Relative. Intersectors search in float whatever the precision.
double toleranceOf(std::string_view pipelineName, Precision precision) {
  const bool inDouble = precision == Precision::doubled && pipelineName != "extend" && pipelineName != "occlude";
  return inDouble ? 1e-6 : 1e-3;
}

template <class S>
void registerPrecision(Precision precision) {
  const Stages<S>& twin = findStages<S>(availableIsas().front(), precision, chooseSpecialization(0, precision));
  const auto add = [&](const char* name, const char* pipelineName, Stage<S> Stages<S>::*member) {
    for (const Isa isa : availableIsas()) {
      const Stages<S>& stages = findStages<S>(isa, precision, chooseSpecialization(0, precision));
      registerShapes<S>({fmt::format("{}/{}", name, toString(isa)), pipelineName, stages.*member, twin.*member,
                         toleranceOf(pipelineName, precision)},
                        precision);
    }
  };
  add("generateCameraPaths", "generate", &Stages<S>::generateCameraPaths);
  add("extendSmall", "extend", &Stages<S>::extendSmall);
  add("extendBvh", "extend", &Stages<S>::extendBvh);
  add("arrive", "arrive", &Stages<S>::arrive);
  add("nextEvent", "next event", &Stages<S>::nextEvent);
  add("occludeSmall", "occlude", &Stages<S>::occludeSmall);
  add("occludeBvh", "occlude", &Stages<S>::occludeBvh);
  add("scatter", "scatter", &Stages<S>::scatter);
  // Embree knows no precision; double differs in the columns it reads.
  const auto addEmbree = [&](size_t width, Stage<S> extend, Stage<S> occlude) {
    registerShapes<S>({fmt::format("extendEmbree/packet:{}", width), "extend", extend, twin.extendSmall,
                       toleranceOf("extend", precision)},
                      precision);
    registerShapes<S>({fmt::format("occludeEmbree/packet:{}", width), "occlude", occlude, twin.occludeSmall,
                       toleranceOf("occlude", precision)},
                      precision);
  };
  addEmbree(4, extendEmbree<S, 4>, occludeEmbree<S, 4>);
  addEmbree(8, extendEmbree<S, 8>, occludeEmbree<S, 8>);
  addEmbree(16, extendEmbree<S, 16>, occludeEmbree<S, 16>);
}

}  // namespace

void registerStageBenchmarks() {
  registerPrecision<float>(Precision::floating);
  registerPrecision<double>(Precision::doubled);
}

}  // namespace wavecrest
