#include "engine/plan/memory_plan.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "engine/film/spread_sums.h"
#include "engine/plan/chain_layout.h"
#include "kernels/columns/light_vertices.h"
#include "kernels/merge/photon_map.h"

namespace wavecrest {
namespace {

template <class Items>
size_t bytesOf(const Items& items) {
  return items.size() * sizeof(items[0]);
}

// Later waves and iterations may need some more room than the first ones.
constexpr double kSpread = 1.05;

// Adds up what a render will hold, part by part. run() is called once.
template <class S>
class Planner {
 public:
  Planner(const RenderPlan<S>& plan, const RenderSettings& settings, const FilmArea& area, const LightPilot& pilot)
      : plan_(plan),
        settings_(settings),
        area_(area),
        emptyStore_(settings.waveSize, plan.needs, plan.lightUse),
        partners_(settings.waveSize, plan.needs, {.merged = false}),
        pilot_(pilot) {
    if (settings.lightPaths && !plan.pipeline.has(Fold::photonMap)) {
      throw std::invalid_argument("planMemory: a number of light paths for " + std::string(toString(settings.method)));
    }
  }

  MemoryPlan run() {
    const size_t pixels = area_.size();
    MemoryUse& use = memory_.use;
    // Count scene, waves, film and image, which every method has.
    use.scene = sceneBytes(*plan_.scene);
    memory_.bytesPerPath = Wave<S>(1, plan_.needs).bytesPerPath();
    use.waves = settings_.threads * waveBytes(memory_.bytesPerPath, settings_.waveSize);
    use.film = area_.bytes() + pixels * sizeof(uint64_t);
    use.film +=
        spreadsSamples(plan_, settings_) ? SpreadSums::bytesFor(plan_.view.camera, area_) : pixels * 3 * sizeof(double);
    use.image = Film::imageBytesFor(pixels, spreadsSamples(plan_, settings_), plan_.pipeline.chains);
    // Count splats, and what chains or light paths hold.
    if (plan_.pipeline.has(Fold::guide)) {
      use.learned = Guide::bytesFor(settings_.guideBytes);
      // Beside the image its luminances, of pixels and of tiles, from which roulette learns (engine/waves/learner.cpp).
      if (settings_.roulette == Roulette::efficiency) use.image += pixels * sizeof(float) * 65 / 64;
    }
    if (plan_.pipeline.splats()) {
      use.splats = SplatFilms::bytesFor(pixels, settings_.threads) +
                   settings_.threads * SplatWriter<S>::bytesFor(pixels, settings_.threads, settings_.waveSize);
    }
    if (plan_.pipeline.chains) {
      addChains();
    } else if (plan_.pipeline.lightPass()) {
      addLightPaths(lightPathsWanted(settings_, pixels));
    }
    // Methods with a photon map have fitted their light paths to the budget. Other methods have nothing to leave out.
    if (settings_.memoryBytes && use.total() > *settings_.memoryBytes) refuse(use.total());
    return memory_;
  }

 private:
  // Waves of walks' ends and a light vertex per lane where walks are joined; chains by the waves they are cut into.
  void addChains() {
    MemoryUse& use = memory_.use;
    memory_.splatScale = std::ldexp(1.0, kSplatUnitBits);  // a chain's splat has luminance 1
    const bool pathSpace = plan_.pipeline.inPathSpace;
    const uint32_t edges = plan_.pathLaws.law().maxEdges;
    if (pathSpace) {
      use.waves += settings_.threads * PathMutations<S>::bytesFor(settings_.waveSize, edges, plan_.needs);
    } else if (plan_.pipeline.lightPass()) {
      use.waves *= kWavesOfJoinedWalks;
      use.lightVertices = settings_.threads * emptyStore_.bytesFor(settings_.waveSize);
    }
    use.chains += settings_.metropolis.bootstrapSamples * kBootstrapSampleBytes;
    const auto kept = keptSamples(plan_.pipeline, plan_.view, settings_.limits.maxDepth);
    const ChainLayout layout(settings_);
    for (size_t wave = 0; wave < layout.waves(); ++wave) {
      use.chains += ChainState::bytesFor(layout.chainsOf(wave), kept);
      if (pathSpace) use.chains += PathStore<S>::bytesFor(settings_.waveSize, edges, plan_.needs);
    }
  }
  // Counts light vertices and photons, as the pilot foresees them. wanted: light paths of an iteration.
  void addLightPaths(size_t wanted) {
    // Where the pilot has no splat, those of the render are rare, and any unit of theirs is fine enough.
    const int64_t exponent = pilot_.splats == 0 ? 0 : pilot_.exponents / pilot_.splats;
    // A splat of the pilot's mean exponent has about 2^kSplatUnitBits units.
    memory_.splatScale = std::ldexp(1.0, kSplatUnitBits - static_cast<int>(exponent));
    const double spread = pilot_.paths < wanted ? kSpread : 1;
    // The pilot has few light paths: its largest wave may be shorter than the render's.
    const auto ofRender = static_cast<double>(std::min<size_t>(wanted, settings_.waveSize)),
               ofPilot = static_cast<double>(std::clamp<size_t>(pilot_.paths, 1, settings_.waveSize));
    memory_.verticesPerWave = static_cast<size_t>(spread * (ofRender / ofPilot) * static_cast<double>(pilot_.room));
    if (plan_.lightUse.connected) memory_.partnerVertices = partnerVertices();
    memory_.lightPaths = wanted;
    if (plan_.pipeline.has(Fold::photonMap) && settings_.memoryBytes) fitLightPaths(*settings_.memoryBytes);
    memory_.use.lightVertices = vertexBytes(memory_.lightPaths);
    if (plan_.pipeline.has(Fold::photonMap)) {
      memory_.photons = photons(memory_.lightPaths);
      memory_.use.photonMap = photonBytes(memory_.lightPaths);
    }
  }

  // Room in a thread's own store. Without a photon map its light walks end there. With one, the vertices of any
  // waveSize light paths are collected there, of fewer paths some of them several times; LightStore::collect asks for
  // room for one more depth.
  size_t partnerVertices() const {
    if (!plan_.pipeline.has(Fold::photonMap)) return memory_.verticesPerWave;
    const auto collected = static_cast<size_t>(kSpread * storedPerPath() * settings_.waveSize);
    return std::max(memory_.verticesPerWave, collected) + settings_.waveSize;
  }

  // Of a wave per thread where light vertices are connected, and with a photon map of all waves of the iterations under
  // way.
  size_t vertexBytes(size_t lightPaths) const {
    const auto bytes = [](const LightStore<S>& store, size_t room) {
      return room == 0 ? store.bytes() : store.bytesFor(room);
    };
    size_t sum = 0;
    if (plan_.lightUse.connected) sum += settings_.threads * bytes(partners_, memory_.partnerVertices);
    if (plan_.pipeline.has(Fold::photonMap)) {
      const size_t waves = piecesOf(lightPaths, settings_.waveSize);
      sum += lightStores(settings_, area_.size(), waves) * bytes(emptyStore_, memory_.verticesPerWave);
    }
    return sum;
  }
  double storedPerPath() const {
    return static_cast<double>(pilot_.stored) / static_cast<double>(std::max<size_t>(pilot_.paths, 1));
  }
  size_t photons(size_t lightPaths) const {
    return static_cast<size_t>(std::llround(storedPerPath() * static_cast<double>(lightPaths)));
  }
  size_t photonBytes(size_t lightPaths) const {
    return iterationsAtOnce(settings_, area_.size()) * PhotonMap<S>::bytesFor(photons(lightPaths));
  }

  // The most light paths, up to those wanted, that leave the plan within the budget.
  void fitLightPaths(size_t budget) {
    const size_t fixed = memory_.use.total();
    const auto needed = [&](size_t paths) { return fixed + vertexBytes(paths) + photonBytes(paths); };
    // One wave of light paths is the least. More light paths never need less memory, so bisection finds the most.
    size_t most = std::min<size_t>(memory_.lightPaths, settings_.mostLightPaths.value_or(memory_.lightPaths)),
           fits = std::min<size_t>(settings_.waveSize, most);
    if (needed(fits) > budget) refuse(needed(fits));
    while (fits < most) {
      const size_t middle = fits + (most - fits + 1) / 2;
      if (needed(middle) <= budget) {
        fits = middle;
      } else {
        most = middle - 1;
      }
    }
    memory_.lightPaths = fits;
  }

  [[noreturn]] void refuse(size_t needed) const {
    const auto megabytes = [](double bytes) { return std::to_string(static_cast<uint64_t>(std::ceil(bytes / 1e6))); };
    throw MemoryBudgetError("this scene needs " + megabytes(static_cast<double>(needed)) + " MB at least by " +
                            std::string(toString(settings_.method)) + "; expected a budget of that or more");
  }

  const RenderPlan<S>& plan_;
  const RenderSettings& settings_;
  const FilmArea& area_;
  const LightStore<S> emptyStore_, partners_;
  const LightPilot& pilot_;
  MemoryPlan memory_;
};

}  // namespace

size_t lightStores(const RenderSettings& settings, size_t pixels, size_t waves) {
  constexpr size_t kAheadPerThread = 4, kMostAhead = 4;  // at most a fourth of the waves
  const size_t atOnce = iterationsAtOnce(settings, pixels);
  // Further stores let idle threads trace light paths of the next iteration. One thread, or several iterations at once,
  // need none.
  if (atOnce > 1 || settings.cutForThreads() == 1) return atOnce * waves;
  return waves + std::min<size_t>(piecesOf(waves, kMostAhead), kAheadPerThread * settings.cutForThreads());
}

template <class S>
size_t primitiveBytes(const CompiledScene<S>& scene) {
  return bytesOf(scene.primitives.records) + bytesOf(scene.primitives.attributes) + bytesOf(scene.instances) +
         (scene.embree ? scene.embree->bytes() : 0) + (scene.bvh ? scene.bvh->bytes() : 0);
}
template size_t primitiveBytes(const CompiledScene<float>&);
template size_t primitiveBytes(const CompiledScene<double>&);

template <class S>
size_t sceneBytes(const CompiledScene<S>& scene) {
  return primitiveBytes(scene) + bytesOf(scene.materials) + bytesOf(scene.compounds) + bytesOf(scene.textures.records) +
         bytesOf(scene.textures.texels) + bytesOf(scene.lights.records) + bytesOf(scene.lights.table) +
         bytesOf(scene.lights.environment.texels) + bytesOf(scene.lights.environment.probability) +
         bytesOf(scene.lights.environment.table);
}
template size_t sceneBytes(const CompiledScene<float>&);
template size_t sceneBytes(const CompiledScene<double>&);

size_t waveBytes(size_t bytesPerPath, size_t waveSize) { return bytesPerPath * paddedItems(waveSize); }

template <class S>
MemoryPlan planMemory(const RenderPlan<S>& plan, const RenderSettings& settings, const FilmArea& area,
                      const LightPilot& pilot) {
  return Planner<S>(plan, settings, area, pilot).run();
}
template MemoryPlan planMemory(const RenderPlan<float>&, const RenderSettings&, const FilmArea&, const LightPilot&);
template MemoryPlan planMemory(const RenderPlan<double>&, const RenderSettings&, const FilmArea&, const LightPilot&);

}  // namespace wavecrest
