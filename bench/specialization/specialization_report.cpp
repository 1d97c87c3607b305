// A SpecializationResult for a terminal and as JSON (bench/schema.json).
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "bench/enumerator_name.h"
#include "bench/estimate_json.h"
#include "bench/specialization/specialization.h"
#include "bench/text_lines.h"
#include "bench/tradeoff/tradeoff.h"

namespace wavecrest {
namespace {

using Json = nlohmann::ordered_json;

// The words with commas between, or "nothing" where there are none.
std::string listed(const std::vector<std::string>& words) {
  return words.empty() ? "nothing" : fmt::format("{}", fmt::join(words, ", "));
}

// Against the complete kernels' image: the same bits, the same but for rounding and chance, or different.
std::string imageInWords(const FeatureSetRow& row) {
  if (row.sameBits) return "same bits";
  return fmt::format("{}, pixels {:.1e}", row.differs ? "DIFFERS" : "same", row.pixelDifference);
}

}  // namespace

// A star marks the kernels that scene and method render with.
std::string toText(const SpecializationResult& result) {
  TextLines text;
  line(text, "{} {} {}x{}: needs {}", result.scene, toString(result.method), result.width, result.height,
       listed(result.needs));
  for (const std::string& doubt : doubtsAbout(result.machine)) line(text, "  doubt: {}", doubt);
  line(text, "  {:<23} {:>9} {:>14} {:>10}   {:<24} {}", "kernels", "M paths/s", "speed-up", "bytes/path", "image",
       "pays for");
  // One line for each feature set.
  for (const FeatureSetRow& row : result.rows) {
    line(text, "{} {:<23} {:>9.3f} {:>7.3f} +-{:.3f} {:>10}   {:<24} {}", row.chosen ? '*' : ' ',
         enumeratorName(kSpecializationNames, row.specialization), 1e-6 * row.pathsPerCpuSecond.value,
         row.speedup.value, row.speedup.interval.halfWidth(), row.bytesPerPath, imageInWords(row), listed(row.paysFor));
  }
  return fmt::to_string(text);
}

// Only the chosen kernels of each result.
std::string specializationSummary(const std::vector<SpecializationResult>& results) {
  TextLines text;
  line(text, "{:<23} {:<5} {:<23} {:>14}   {}", "scene", "", "kernels", "over complete", "pays for");
  for (const SpecializationResult& result : results) {
    const FeatureSetRow& row = result.chosen();
    line(text, "{:<23} {:<5} {:<23} {:>7.3f} +-{:.3f}   {}", result.scene, toString(result.method),
         enumeratorName(kSpecializationNames, row.specialization), row.speedup.value, row.speedup.interval.halfWidth(),
         listed(row.paysFor));
  }
  return fmt::to_string(text);
}

Json toJson(const SpecializationResult& result) {
  Json rows = Json::array();
  for (const FeatureSetRow& row : result.rows) {
    rows.push_back({{"kernels", enumeratorName(kSpecializationNames, row.specialization)},
                    {"chosen", row.chosen},
                    {"pays_for", row.paysFor},
                    {"paths_per_cpu_second", row.pathsPerCpuSecond.value},
                    {"paths_per_cpu_second_interval", intervalJson(row.pathsPerCpuSecond.interval)},
                    {"speedup", row.speedup.value},
                    {"speedup_interval", intervalJson(row.speedup.interval)},
                    {"bytes_per_path", row.bytesPerPath},
                    {"same_bits", row.sameBits},
                    {"pixel_difference", row.pixelDifference},
                    {"bias", biasJson(row.mean)},
                    {"worst_block", biasJson(row.worstBlock)},
                    {"differs", row.differs}});
  }
  return {{"scene", result.scene},
          {"method", std::string(toString(result.method))},
          {"width", result.width},
          {"height", result.height},
          {"iterations", result.iterations},
          {"seeds", kSpecializationSeeds},
          {"level", kSpecializationLevel},
          {"needs", result.needs},
          {"rows", rows},
          {"doubts", doubtsAbout(result.machine)}};
}

}  // namespace wavecrest
