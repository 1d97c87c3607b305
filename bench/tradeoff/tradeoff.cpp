#include "bench/tradeoff/tradeoff.h"

#include <algorithm>
#include <cmath>

#include "bench/machine/energy.h"
#include "bench/tradeoff/block_means.h"
#include "bench/tradeoff/seed_variances.h"
#include "engine/inspect/path_classes.h"
#include "engine/plan/render_plan.h"
#include "engine/scene/scene_error.h"
#include "engine/session/session.h"

namespace wavecrest {
namespace {

constexpr size_t kReferenceSeeds = 6;
constexpr double kReferencePart = 0.3;                  // of the time
constexpr uint64_t kFirstReferenceSeed = 0x7472616465;  // unlike any that a user picks

using Film = std::vector<float>;

// One render of a setting with one seed. bytes: memory of the whole render.
struct OneRender {
  Film film;
  double cpuSeconds = 0, paths = 0;
  uint64_t iterations = 0;
  size_t bytes = 0;
  std::optional<double> joules;
  Accel accel{};
};

// Renders until so many iterations or seconds. Energy is that of rendering alone, without building the scene.
OneRender render(const Scene& scene, const RenderSettings& settings, std::optional<uint64_t> iterations,
                 std::optional<double> seconds) {
  const auto session = Session::create(scene, settings);
  const std::optional<double> energy = packageJoules();
  session->renderUntil(iterations, seconds);
  session->renderUntil(1, std::nullopt);  // a whole image, however long that takes
  const std::optional<double> energyAfter = packageJoules();
  const RenderStatistics statistics = session->statistics();
  OneRender done{.film = session->film().resolve(),
                 .cpuSeconds = statistics.cpuSeconds,
                 .paths = static_cast<double>(statistics.paths),
                 .iterations = statistics.iterations,
                 .bytes = statistics.memory.total(),
                 .joules = {},
                 .accel = statistics.accel};
  // The counter wraps around now and then. The energy of a render with a wrap is unknown.
  if (energy && energyAfter && *energyAfter > *energy) done.joules = *energyAfter - *energy;
  return done;
}

// The image in double by the method that samples every class of paths, in parts of different seeds.
struct TradeReference {
  ReferenceChoice choice;
  Film mean;
  std::vector<BlockMeans> parts;
};

TradeReference renderReference(const Scene& scene, const RenderSettings& base, double seconds) {
  RenderSettings settings = base;
  settings.precision = Precision::doubled;
  TradeReference reference{.choice = classifyPaths(scene).reference, .mean = {}, .parts = {}};
  settings.method = reference.choice.method;
  const uint32_t width = filmArea(scene.film).width;
  for (size_t i = 0; i < kReferenceSeeds; ++i) {
    settings.seed = kFirstReferenceSeed + i;
    const Film film = render(scene, settings, {}, seconds / kReferenceSeeds).film;
    reference.mean.resize(film.size(), 0.0f);
    for (size_t k = 0; k < film.size(); ++k) reference.mean[k] += film[k] / static_cast<float>(kReferenceSeeds);
    reference.parts.push_back(blockMeans(film, width));
  }
  return reference;
}

// The renders of one setting with all seeds.
struct Measured {
  std::string refusal;
  std::vector<double> cpuSeconds;
  SeedVariances variances;  // of one image
  std::vector<BlockMeans> blocks;
  double paths = 0;
  std::optional<double> joules = 0;
  size_t bytes = 0;

  void add(const OneRender& one, const TradeReference& reference, uint32_t width) {
    variances.add(one.film, reference.mean, width);
    blocks.push_back(blockMeans(one.film, width));
    cpuSeconds.push_back(one.cpuSeconds);
    paths += one.paths;
    bytes = one.bytes;
    joules = joules && one.joules ? std::optional(*joules + *one.joules) : std::nullopt;
  }
};

// Variance times time, seed by seed.
// The first seed has no variance, so variance i belongs to the time of seed i + 1.
std::vector<double> costs(const Measured& measured) {
  std::vector<double> values = measured.variances.values();
  for (size_t i = 0; i < values.size(); ++i) values[i] *= measured.cpuSeconds[i + 1];
  return values;
}

TradeRow rowOf(const Variant& variant, const Measured& own, const Measured& base, const Measured& doubled,
               const TradeReference& reference) {
  TradeRow row;
  row.knob = variant.knob;
  row.value = variant.value;
  row.refusal = own.refusal;
  row.samePaths = variant.samePaths;
  if (!own.refusal.empty()) return row;
  // Speed, energy and memory.
  double cpu = 0;
  for (const double seconds : own.cpuSeconds) cpu += seconds;
  row.pathsPerCpuSecond = own.paths / cpu;
  if (own.joules) row.joulesPerPath = *own.joules / own.paths;
  row.bytes = own.bytes;
  row.speed = medianRatio(base.cpuSeconds, own.cpuSeconds);
  // Noise. Variance falls as 1 / time, so a relative error of 0.01 takes cost / 0.01^2 seconds.
  row.efficiency = medianRatio(costs(base), costs(own));
  row.secondsToPercent = median(costs(own)) / (0.01 * 0.01);
  // Bias: seed by seed against double where the paths are the same, otherwise against the reference.
  const BlockComparison compared =
      variant.samePaths ? comparePaired(own.blocks, doubled.blocks) : compareIndependent(own.blocks, reference.parts);
  row.mean = compared.mean;
  row.worstBlock = compared.worstBlock;
  return row;
}

// A verdict for the mean and one for the blocks of every row, together at kTradeLevel (Bonferroni).
void judge(std::vector<TradeRow>& rows, uint32_t seeds) {
  if (!tellsBias(seeds)) return;
  const auto verdicts = static_cast<double>(verdictsOf(rows));
  for (TradeRow& row : rows) {
    for (const Bias& bias : {row.mean, row.worstBlock}) {
      row.biased |= bias.probability < kTradeLevel / verdicts && std::abs(bias.value) > kNegligibleBias;
    }
  }
}

}  // namespace

TradeResult measureTrade(const Scene& scene, const RenderSettings& base, const TradeEffort& effort) {
  const FilmArea area = filmArea(scene.film);
  TradeResult result;
  result.scene = scene.name;
  result.method = base.method;
  result.width = area.width;
  result.height = area.height;
  result.seeds = effort.seeds;
  std::vector<Variant> variants = variantsOf(scene, base);
  if (!effort.knobs.empty()) variants = chooseVariants(std::move(variants), effort.knobs);
  // The double reference takes a fixed part of the time.
  MachineWatch watch;
  const TradeReference reference = renderReference(scene, base, kReferencePart * effort.seconds);
  result.referenceMethod = reference.choice.method;
  result.referenceBiased = reference.choice.biased;

  // All variants render the same iterations: as many as the baseline does in a share of the rest of the time, what it
  // does once before the first included.
  const double share = (1 - kReferencePart) * effort.seconds / static_cast<double>(effort.seeds * variants.size());
  const OneRender first = render(scene, base, {}, share);
  result.iterations = std::max<uint64_t>(1, first.iterations);
  std::vector<Measured> measured(variants.size());
  for (size_t i = 0; i < variants.size(); ++i) {
    // `small` tests every primitive of the scene for every ray: in a large mesh an iteration takes minutes.
    if (variants[i].settings.accel == Accel::small && first.accel != Accel::small) {
      measured[i].refusal = "for scenes of few primitives; this one has too many";
    }
  }
  // Variants in turn, forwards and backwards, so that drift of the machine meets all of them.
  for (size_t seed = 0; seed < effort.seeds; ++seed) {
    for (size_t k = 0; k < variants.size(); ++k) {
      const size_t i = seed % 2 == 0 ? k : variants.size() - 1 - k;
      if (!measured[i].refusal.empty()) continue;
      RenderSettings settings = variants[i].settings;
      settings.seed = base.seed + seed;
      try {
        measured[i].add(render(scene, settings, result.iterations, {}), reference, area.width);
      } catch (const SceneError& error) {
        measured[i].refusal = error.what();
      }
    }
    watch.look();
  }
  // Each variant against the baseline and against double.
  const auto isDouble = [](const Variant& variant) { return variant.settings.precision == Precision::doubled; };
  const auto doubled = std::find_if(variants.begin(), variants.end(), isDouble) - variants.begin();
  for (size_t i = 0; i < variants.size(); ++i) {
    result.rows.push_back(
        rowOf(variants[i], measured[i], measured.front(), measured[static_cast<size_t>(doubled)], reference));
  }
  judge(result.rows, effort.seeds);
  result.machine = watch.state();
  return result;
}

}  // namespace wavecrest
