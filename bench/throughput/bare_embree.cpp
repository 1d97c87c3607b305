#include "bench/throughput/bare_embree.h"

#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "bench/machine/cpu_timer.h"
#include "bench/throughput/turns.h"
#include "bench/throughput/wave_capture.h"
#include "engine/tasks/flush_to_zero.h"
#include "kernels/extend/embree_packets.h"

namespace wavecrest {
namespace {

using RayHits = Packet<kEmbreePacket>::RayHit;
using Segments = Packet<kEmbreePacket>::Ray;

constexpr size_t kRepeats = 3;  // of each timing; the median counts

// Rays of one kind over all waves and depths, and the CPU time of each intersector for them.
struct Total {
  uint64_t rays = 0;
  double bare = 0, notRobust = 0, embreeStage = 0, usedStage = 0;  // seconds
  RayRates rates() const {
    const auto rate = [&](double seconds) { return rays == 0 ? 0 : static_cast<double>(rays) / seconds; };
    return {rays, rate(bare), rate(notRobust), rate(embreeStage), rate(usedStage)};
  }
};

// Median CPU time of run(), prepared anew by prepare() each time.
template <class Prepare, class Run>
double secondsOf(Prepare&& prepare, Run&& run) {
  std::vector<double> seconds(kRepeats);
  for (double& s : seconds) {
    prepare();
    CpuTimer timer;
    timer.start();
    run();
    s = timer.seconds();
  }
  return median(std::move(seconds));
}

// Traces waves as the render does, and times three intersectors on the rays of each intersection stage right before it
// runs: bare Embree, our stage on Embree, and the stage of this render.
class Comparison {
 public:
  Comparison(const Scene& scene, const RenderSettings& settings)
      : used_(scene, settings),
        embree_(scene, onEmbree(settings)),
        notRobust_(compileScene<float>(scene, Accel::embree, false, settings.instancing)),
        wave_(used_.makeWave()),
        scratch_(used_.makeWave()) {
    // All stages run in the context of used_, so its scene needs Embree's scene as well.
    used_.plan().view.embree = scene_ = embree_.plan().view.embree;
  }

  // Adds the rays of a wave, of all depths.
  void addWave(size_t index) {
    used_.trace(wave_, used_.waveFromAllOver(index), [&](std::string_view stage, uint32_t depth, Wave<float>& wave) {
      if (stage == "extend") addExtend(depth, wave);
      if (stage == "occlude" && wave.shadowRays.size != 0) addOcclude(depth, wave);
      return true;
    });
  }
  bool possible() const { return used_.tracesWholeMethod(); }
  size_t waveCount() const { return used_.waveCount(); }
  BareEmbree result() const { return {closest_.rates(), anyHit_.rates()}; }

 private:
  static RenderSettings onEmbree(RenderSettings settings) {
    settings.accel = Accel::embree;
    return settings;
  }

  // CPU time of a stage on a copy of the wave. Making the copy is not timed.
  double stageSeconds(Stage<float> stage, uint32_t depth, const Wave<float>& wave) {
    const StageContext<float> context = used_.context(depth);
    return secondsOf([&] { scratch_.copyFrom(wave); }, [&] { stage(context, scratch_); });
  }

  // Packets of one stage call: fill(packet, first ray) for each, then call(valid, packet) on all, timed.
  template <class Record, class Fill, class Call>
  double bareSeconds(std::vector<Record>& packets, size_t count, Fill&& fill, Call&& call) {
    packets.resize((count + kEmbreePacket - 1) / kEmbreePacket);
    // All packets but the last are full.
    alignas(64) int all[kEmbreePacket], last[kEmbreePacket];
    setValid(kEmbreePacket, all);
    setValid(count - (packets.size() - 1) * kEmbreePacket, last);
    // Embree writes its results into the packets, so each repetition fills all packets anew. Filling is not timed.
    return secondsOf(
        [&] {
          for (size_t i = 0; i < packets.size(); ++i) fill(packets[i], i * kEmbreePacket);
        },
        [&] {
          for (size_t i = 0; i + 1 < packets.size(); ++i) call(all, packets[i]);
          call(last, packets.back());
        });
  }

  void addExtend(uint32_t depth, const Wave<float>& wave) {
    Query query;
    closest_.rays += wave.rays.size;
    const auto secondsOn = [&](void* scene) {
      return bareSeconds(
          rayHits_, wave.rays.size,
          [&](RayHits& packet, size_t first) {
            // Rays have no end.
            setSegment(std::numeric_limits<float>::infinity(), packet.ray);
            copyRays<float>(wave.rays, first, packet.ray);
            setNoHit(packet);
          },
          [&](const int* valid, RayHits& packet) {
            query(Packet<kEmbreePacket>::intersect, valid, static_cast<RTCScene>(scene), packet);
          });
    };
    closest_.bare += secondsOn(scene_);
    closest_.notRobust += secondsOn(notRobust_->view.embree);
    closest_.embreeStage += stageSeconds(extendEmbree<float>, depth, wave);
    closest_.usedStage += stageSeconds(stageNamed("extend"), depth, wave);
  }

  void addOcclude(uint32_t depth, const Wave<float>& wave) {
    Query query;
    anyHit_.rays += wave.shadowRays.size;
    const auto secondsOn = [&](void* scene) {
      return bareSeconds(
          segments_, wave.shadowRays.size,
          [&](Segments& packet, size_t first) {
            // A shadow ray's direction spans its segment. Hits count in [0, 1).
            setSegment(std::nextafter(1.0f, 0.0f), packet);
            copyRays<float>(wave.shadowRays, first, packet);
          },
          [&](const int* valid, Segments& packet) {
            query(Packet<kEmbreePacket>::occluded, valid, static_cast<RTCScene>(scene), packet);
          });
    };
    anyHit_.bare += secondsOn(scene_);
    anyHit_.notRobust += secondsOn(notRobust_->view.embree);
    anyHit_.embreeStage += stageSeconds(occludeEmbree<float>, depth, wave);
    anyHit_.usedStage += stageSeconds(stageNamed("occlude"), depth, wave);
  }

  // The camera pass' stage of this name, on the intersector that renders the scene.
  Stage<float> stageNamed(std::string_view name) {
    for (const StageCall<float>& stage : used_.plan().pipeline.cameraPass().perDepth) {
      if (stage.name == name) return stage.run;
    }
    throw std::logic_error("the pipeline has no such stage");
  }

  WaveCapture<float> used_, embree_;
  std::unique_ptr<CompiledScene<float>> notRobust_;
  Wave<float> wave_, scratch_;
  void* scene_ = nullptr;
  std::vector<RayHits> rayHits_;
  std::vector<Segments> segments_;
  Total closest_, anyHit_;
};

}  // namespace

std::optional<BareEmbree> measureBareEmbree(const Scene& scene, const RenderSettings& settings, double seconds) {
  RenderSettings own = settings;
  own.precision = Precision::floating;
  // The floating-point mode of a render.
  const FlushToZero flushToZero;
  Comparison comparison(scene, own);
  if (!comparison.possible()) return std::nullopt;
  // Waves from all over the film, until the time is over.
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  size_t wave = 0;
  do {
    comparison.addWave(wave);
  } while (++wave < comparison.waveCount() && Clock::now() < end);
  return comparison.result();
}

}  // namespace wavecrest
