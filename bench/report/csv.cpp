#include "bench/report/csv.h"

#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "bench/report/html_text.h"
#include "bench/report/series_values.h"
#include "bench/report/time_ahead.h"

namespace wavecrest {
namespace {

// Quoted where a comma, a quote or a line end would be misread. A spreadsheet takes what begins like a formula for one,
// so such a text gets an apostrophe in front.
std::string field(std::string_view text) {
  const bool formula = !text.empty() && std::string_view("=+-@\t\r").find(text.front()) != std::string_view::npos;
  const std::string_view mark = formula ? "'" : "";
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(mark).append(text);
  std::string quoted = std::string("\"").append(mark);
  for (const char character : text) {
    if (character == '"') quoted += '"';
    quoted += character;
  }
  return quoted + '"';
}

// Scores that people ask times to, by the keys of their metrics.
constexpr std::array<std::pair<std::string_view, double>, 4> kAskedScores{
    {{"ssim", 0.9}, {"ssim", 0.95}, {"q_mos", 80}, {"q_mos", 90}}};

// The shortest text that reads back as the same number; empty where there is none.
std::string number(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

}  // namespace

std::string measurementsAsCsv(const ConvergenceReport& report) {
  std::string csv = "scene,method,series,seed,snapshot,seconds,iterations,metric,value\n";
  for (const ReportScene& scene : report.scenes) {
    for (const ReportSeries& series : scene.series) {
      // The fields that all lines of a series begin with.
      const std::string start = fmt::format("{},{},{}", field(scene.name), field(series.method), field(series.label));
      for (const ReportRun& run : series.runs) {
        for (const ReportPoint& point : run.points) {
          // A line for each metric of the report, then one for each further score.
          const auto add = [&](const std::string& metric, double value) {
            append(csv, "{},{},{},{},{},{},{}\n", start, run.seed, point.number, number(point.seconds),
                   point.iterations, field(metric), number(value));
          };
          for (size_t m = 0; m < report.metrics.size(); ++m) add(report.metrics[m].key, point.values[m]);
          for (const NamedNumber& score : point.further) add(score.name, score.value);
        }
      }
    }
  }
  return csv;
}

std::string claimsAsCsv(const ConvergenceReport& report) {
  std::string csv = "id,scene,statement,source,verdict,figure,explanation,evidence\n";
  for (const ReportClaim& claim : report.claims) {
    append(csv, "{},{},{},{},{},{},{},{}\n", field(claim.id), field(claim.scene), field(claim.statement),
           field(claim.source), field(claim.verdict), field(claim.figure),
           field(claim.explainedHere ? claim.explanation : ""), field(claim.evidence));
  }
  return csv;
}

std::string summaryAsCsv(const ConvergenceReport& report) {
  std::string csv =
      "scene,method,series,seeds,metric,mean,low,high,noise_floor,best,target,seconds_to_target,at_most,fastest\n";
  for (const ReportScene& scene : report.scenes) {
    for (const ReportSeries& series : scene.series) {
      for (size_t m = 0; m < report.metrics.size(); ++m) {
        const ReportMetric& metric = report.metrics[m];
        // The score at the end, its extremes over seeds and the noise floor.
        const Range range = finalRange(series, m);
        const std::optional<double> floor = noiseFloorOf(scene, m);
        append(csv, "{},{},{},{},{},{},{},{},{}", field(scene.name), field(series.method), field(series.label),
               series.runs.size(), field(metric.key), number(finalValue(series, m)), number(range.low),
               number(range.high), floor ? number(*floor) : "");
        // "yes" where the series is the best beyond noise, else empty.
        append(csv, ",{}", isClearlyBest(scene, series, metric, m) ? "yes" : "");
        // The time to the target. These columns stay empty for a metric without one.
        if (metric.target) {
          const std::optional<TargetTime> time = timeToReach(series, metric, m, *metric.target);
          append(csv, ",{},{},{},{}\n", number(*metric.target), time ? number(time->seconds) : "",
                 time && time->atMost ? "yes" : "",
                 isClearlyFastest(scene, series, metric, m, *metric.target) ? "yes" : "");
        } else {
          csv += ",,,,\n";
        }
      }
    }
  }
  return csv;
}

std::string timesAsCsv(const ConvergenceReport& report) {
  std::string csv = "scene,method,series,metric,target,seconds,at_most,seconds_ahead,low,high,near_floor\n";
  for (const ReportScene& scene : report.scenes) {
    for (const ReportSeries& series : scene.series) {
      for (const auto& [key, target] : kAskedScores) {
        const std::optional<size_t> m = findMetric(report, key);
        if (!m) continue;
        const ReportMetric& metric = report.metrics[*m];
        const std::optional<double> floor = noiseFloorOf(scene, *m);
        append(csv, "{},{},{},{},{}", field(scene.name), field(series.method), field(series.label), key, target);
        const std::optional<TargetTime> time = timeToReach(series, metric, *m, target);
        append(csv, ",{},{}", time ? number(time->seconds) : "", time && time->atMost ? "yes" : "");
        const std::optional<TimeAhead> ahead = timeAhead(series, metric, *m, target, floor);
        if (ahead) {
          append(csv, ",{},{},{}", number(ahead->end + ahead->seconds), number(ahead->end + ahead->interval.low),
                 isOpen(*ahead) ? "" : number(ahead->end + ahead->interval.high));
        } else {
          csv += ",,,";
        }
        append(csv, ",{}\n", isNearFloor(metric, target, floor) ? "yes" : "");
      }
    }
  }
  return csv;
}

}  // namespace wavecrest
