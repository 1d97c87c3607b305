// The table of `bench --against` for a terminal.
#include "bench/against/against.h"
#include "bench/text_lines.h"

namespace wavecrest {

std::string toText(const AgainstResult& result) {
  TextLines text;
  line(text, "this:  {} ({})", result.ours.string(), result.ourVersion);
  line(text, "other: {} ({})", result.other.string(), result.otherVersion);
  const size_t runs = result.rows.empty() ? 0 : result.rows.front().ourSeconds.size();
  line(text,
       "{} pairs of runs in turn on {} thread{}; speed: CPU time of the other over this one's, with {:.0f} % interval",
       runs, result.threads, result.threads == 1 ? "" : "s", 100 * kIntervalLevel);
  line(text, "\n{:<24} {:<6} {:>5} {:>9} {:>9} {:>7} {:>17} {:>9}  {:<14} {}", "scene", "method", "spp", "other s",
       "this s", "speed", "interval", "p", "verdict", "image");
  for (const AgainstRow& row : result.rows) {
    const Comparison& c = row.comparison;
    const std::string image = row.sameImage ? "same" : fmt::format("differs by {:.2g}", row.imageDifference);
    line(text, "{:<24} {:<6} {:>5} {:>9.4f} {:>9.4f} {:>7.4f} {:>8.4f}-{:<8.4f} {:>9.2g}  {:<14} {}", row.scene,
         row.method, row.iterations, median(row.otherSeconds), median(row.ourSeconds), c.speedup, c.interval.low,
         c.interval.high, c.probability, toString(c.verdict), image);
  }
  line(text,
       "\np: signed-rank test of the pairs, corrected for {} comparison{} (Holm): a false verdict anywhere in {:g} of "
       "100",
       result.rows.size(), result.rows.size() == 1 ? "" : "s", 100 * result.family.level);
  for (const std::filesystem::path& program : result.inPlace) {
    line(text, "{} runs only where it stands: a few per cent of difference may come from where its file lies in memory",
         program.string());
  }
  if (result.family.tolerance > 0) {
    line(text, "a loss of up to {:g} % is tolerated", 100 * result.family.tolerance);
  }
  return fmt::to_string(text);
}

}  // namespace wavecrest
