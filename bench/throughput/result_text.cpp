// Tables of a SceneResult for a terminal.
#include <fmt/format.h>

#include <iterator>

#include "bench/enumerator_name.h"
#include "bench/throughput/bench_scene.h"

namespace wavecrest {
namespace {

using Text = fmt::memory_buffer;

template <class... Arguments>
void line(Text& text, fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  fmt::format_to(std::back_inserter(text), format, std::forward<Arguments>(arguments)...);
  text.push_back('\n');
}

double millions(double perSecond) { return perSecond * 1e-6; }

void addSpeed(Text& text, const Speed& speed, uint32_t threads) {
  line(text, "  {:.3f} M paths/s on {} thread{}, {:.3f} per core; {:.2f} rays/path, {:.1f} M rays/s, {:.1f} per core",
       millions(speed.pathsPerSecond), threads, threads == 1 ? "" : "s", millions(speed.pathsPerCpuSecond),
       speed.raysPerPath, millions(speed.raysPerSecond), millions(speed.raysPerCpuSecond));
  line(text, "  {} kernels on {}, intersector {}; {} bytes/path",
       enumeratorName(kSpecializationNames, speed.facts.specialization), toString(speed.facts.isa),
       enumeratorName(kAccelNames, speed.facts.accel), speed.bytesPerPath);
  line(text, "\n  {:<18} {:>10} {:>9} {:>9} {:>7} {:>9}", "stage", "items/path", "ns/item", "ns/path", "share",
       "lane use");
  for (const StageShare& stage : speed.stages) {
    const std::string laneUse = stage.laneUse ? fmt::format("{:.1f}%", 100 * *stage.laneUse) : "-";
    line(text, "  {:<18} {:>10.3f} {:>9.2f} {:>9.2f} {:>6.1f}% {:>9}", stage.name, stage.itemsPerPath, stage.nsPerItem,
         stage.nsPerPath, 100 * stage.share, laneUse);
  }
  line(text, "  {:<18} {:>10} {:>9} {:>9.2f} {:>6.1f}%", "film, rest", "", "",
       1e9 * speed.restShare / speed.pathsPerCpuSecond, 100 * speed.restShare);
  line(text, "\n  {:<12} {:>12} {:>9} {:>16}", "threads", "M paths/s", "speedup", "CPU efficiency");
  for (const ScalingRow& row : speed.scaling) {
    line(text, "  {:<12} {:>12.3f} {:>9.2f} {:>15.1f}%", row.threads, millions(row.pathsPerSecond), row.speedup,
         100 * row.cpuEfficiency);
  }
}

void addBareEmbree(Text& text, const BareEmbree& embree, const Speed& speed) {
  line(text, "\n  {:<12} {:>12} {:>12} {:>8} {:>12} {:>8}", "M rays/s core", "bare Embree", "Embree stage", "ratio",
       "stage used", "ratio");
  const auto row = [&](const char* name, const RayRates& rates) {
    if (rates.rays == 0) return;
    line(text, "  {:<12} {:>13.2f} {:>12.2f} {:>8.2f} {:>12.2f} {:>8.2f}", name, millions(rates.bare),
         millions(rates.embreeStage), rates.embreeStage / rates.bare, millions(rates.usedStage),
         rates.usedStage / rates.bare);
  };
  row("closest hit", embree.closest);
  row("any hit", embree.anyHit);
  line(text, "  {:<12} {:>13.2f} {:>12} {:>8} {:>12.2f} {:>8.2f}", "whole render", millions(embree.raysPerSecond()), "",
       "", millions(speed.raysPerCpuSecond), speed.raysPerCpuSecond / embree.raysPerSecond());
}

void addPolicies(Text& text, const PolicyTable& table) {
  line(text, "\n  precision policies and instruction sets; differences after {} iterations of the same random numbers",
       table.iterations);
  line(text, "  {:<9} {:<8} {:<21} {:>16} {:>15} {:>16} {:>11}", "precision", "isa", "kernels", "M paths/s core",
       "mean vs double", "pixels vs double", "bytes/path");
  for (const PolicyRow& row : table.rows) {
    // A slow policy may not get a turn within the duration.
    const std::string speed = row.pathsPerCpuSecond > 0 ? fmt::format("{:.3f}", millions(row.pathsPerCpuSecond)) : "-";
    line(text, "  {:<9} {:<8} {:<21} {:>16} {:>15.1e} {:>16.1e} {:>11}", enumeratorName(kPrecisionNames, row.precision),
         toString(row.isa), enumeratorName(kSpecializationNames, row.specialization), speed, row.meanDifference,
         row.pixelDifference, row.bytesPerPath);
  }
}

void addErrors(Text& text, const SceneResult& result) {
  line(text, "\n  relMSE at equal time (reference: {:.2g} s, its own noise {:.1e}, subtracted)",
       result.reference.seconds, result.reference.noise);
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
