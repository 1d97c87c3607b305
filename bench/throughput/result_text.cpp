// Tables of a SceneResult for a terminal.
#include "bench/enumerator_name.h"
#include "bench/statistics/biased_reference.h"
#include "bench/text_lines.h"
#include "bench/throughput/bench_scene.h"
#include "bench/throughput/doubts.h"

namespace wavecrest {
namespace {

using Text = TextLines;

double millions(double perSecond) { return perSecond * 1e-6; }

// A rate in millions and how far the interval's ends are from it: "1.412 +-0.6%".
std::string rate(const Estimate& estimate, int digits = 3) {
  return fmt::format("{:.{}f} +-{:.1f}%", millions(estimate.value), digits, 100 * estimate.relativeError());
}
// A share in percent. The half width of the interval is in percentage points.
std::string percent(const Estimate& estimate) {
  return fmt::format("{:.1f}% +-{:.1f}", 100 * estimate.value, 100 * estimate.interval.halfWidth());
}

// Work and time of the stages on one thread. The last line is the time outside all stages.
void addStages(Text& text, const Speed& speed) {
  line(text, "\n  {:<18} {:>10} {:>9} {:>7} {:>9} {:>14} {:>9}", "stage", "items/path", "ns/item", "+-%", "ns/path",
       "share", "lane use");
  for (const StageShare& stage : speed.stages) {
    const std::string laneUse = stage.laneUse ? fmt::format("{:.1f}%", 100 * *stage.laneUse) : "-";
    line(text, "  {:<18} {:>10.3f} {:>9.2f} {:>7.1f} {:>9.2f} {:>14} {:>9}", stage.name, stage.itemsPerPath,
         stage.nsPerItem.value, 100 * stage.nsPerItem.relativeError(), stage.nsPerPath.value, percent(stage.share),
         laneUse);
  }
  // Nanoseconds per path: the share of the CPU time of a path.
  line(text, "  {:<18} {:>10} {:>9} {:>7} {:>9.2f} {:>14}", "film, rest", "", "", "",
       1e9 * speed.restShare.value / speed.pathsPerCpuSecond.value, percent(speed.restShare));
}

// Rates, doubts, stages, and growth with threads.
void addSpeed(Text& text, const Speed& speed, uint32_t threads) {
  const VisitSlices& visits = speed.scaling.front().slices;
  line(text, "  {} M paths/s on {} thread{}, {} per core; {:.2f} rays/path, {} M rays/s, {} per core",
       rate(speed.pathsPerSecond), threads, threads == 1 ? "" : "s", rate(speed.pathsPerCpuSecond), speed.raysPerPath,
       rate(speed.raysPerSecond, 1), rate(speed.raysPerCpuSecond, 1));
  line(text,
       "  {} kernels on {}, intersector {}; {} bytes/path; medians of {} slices in {} visits, +-: {:.0f} % interval",
       enumeratorName(kSpecializationNames, speed.facts.specialization), toString(speed.facts.isa),
       enumeratorName(kAccelNames, speed.facts.accel), speed.bytesPerPath, allSlices(visits).size(), visits.size(),
       100 * kIntervalLevel);
  for (const std::string& doubt : doubtsAbout(speed)) line(text, "  doubt: {}", doubt);
  addStages(text, speed);
  line(text, "\n  {:<12} {:>16} {:>15} {:>18}", "threads", "M paths/s", "speedup", "CPU efficiency");
  for (const ScalingRow& row : speed.scaling) {
    line(text, "  {:<12} {:>16} {:>15} {:>18}", row.threads, rate(row.pathsPerSecond), times(row.speedup),
         percent(row.cpuEfficiency));
  }
}

// Rays per second of one core. The last line compares all rays of the render, shading included, with Embree alone.
void addBareEmbree(Text& text, const BareEmbree& embree, const Speed& speed) {
  line(text, "\n  {:<12} {:>12} {:>11} {:>13} {:>11} {:>10} {:>11}", "M rays/s core", "bare Embree", "not robust",
       "Embree stage", "stage used", "/ robust", "/ not robust");
  const auto row = [&](const char* name, const RayRates& rates) {
    if (rates.rays == 0) return;
    line(text, "  {:<12} {:>13.2f} {:>11.2f} {:>13.2f} {:>11.2f} {:>10.2f} {:>12.2f}", name, millions(rates.bare),
         millions(rates.notRobust), millions(rates.embreeStage), millions(rates.usedStage),
         rates.usedStage / rates.bare, rates.usedStage / rates.notRobust);
  };
  row("closest hit", embree.closest);
  row("any hit", embree.anyHit);
  line(text, "  {:<12} {:>13.2f} {:>11} {:>13} {:>11.2f} {:>10.2f}", "whole render", millions(embree.raysPerSecond()),
       "", "", millions(speed.raysPerCpuSecond.value), speed.raysPerCpuSecond.value / embree.raysPerSecond());
}

// Differences are relative to the image of double precision.
void addPolicies(Text& text, const PolicyTable& table) {
  line(text, "\n  precision policies and instruction sets; differences after {} iterations of the same random numbers",
       table.iterations);
  line(text, "  {:<9} {:<8} {:<21} {:>16} {:>15} {:>16} {:>11}", "precision", "isa", "kernels", "M paths/s core",
       "mean vs double", "pixels vs double", "bytes/path");
  for (const PolicyRow& row : table.rows) {
    // Without an interval the median stands alone.
    const std::string paths = row.pathsPerCpuSecondInterval
                                  ? rate({row.pathsPerCpuSecond, *row.pathsPerCpuSecondInterval})
                                  : fmt::format("{:.3f}", millions(row.pathsPerCpuSecond));
    line(text, "  {:<9} {:<8} {:<21} {:>16} {:>15.1e} {:>16.1e} {:>11}", enumeratorName(kPrecisionNames, row.precision),
         toString(row.isa), enumeratorName(kSpecializationNames, row.specialization), paths, row.meanDifference,
         row.pixelDifference, row.bytesPerPath);
  }
}

// relMSE over time. The efficiency is that of the last point.
void addErrors(Text& text, const SceneResult& result) {
  line(text, "\n  relMSE at equal time (reference: {}, {:.2g} s, its own noise {:.1e}, subtracted)",
       toString(result.reference.method), result.reference.seconds, result.reference.noise);
  if (result.reference.biased) line(text, "  doubt: {}", referenceBlurs(result.reference.method));
  for (const ErrorRow& row : result.errors) {
    std::string points;
    for (const ErrorAtTime& at : row.points) {
      points += fmt::format("  {:.2e} at {:.2f} s ({:.1f} spp)", at.relmse, at.seconds, at.samplesPerPixel);
    }
    line(text, "  {:<5} {:<12}{}  efficiency {:.0f}", toString(row.method), toString(row.sampler), points,
         row.points.back().efficiency);
  }
}

}  // namespace

std::string toText(const SceneResult& result) {
  Text text;
  for (const MethodResult& method : result.methods) {
    line(text, "{} {} {}x{}", result.scene, toString(method.method), result.width, result.height);
    addSpeed(text, method.speed, result.threads);
    if (method.bareEmbree) addBareEmbree(text, *method.bareEmbree, method.speed);
    addPolicies(text, method.policies);
  }
  addErrors(text, result);
  return fmt::to_string(text);
}

}  // namespace wavecrest
