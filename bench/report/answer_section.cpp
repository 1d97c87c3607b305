#include "bench/report/answer_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/report/html_text.h"
#include "bench/report/method_style.h"
#include "bench/report/series_values.h"
#include "bench/report/time_ahead.h"

namespace wavecrest {
namespace {

// Times within this of the fastest are level with it, where noise does not tell them apart either.
constexpr double kLevel = 1.25;

// The scenes that one choice of methods is the answer for.
struct Group {
  std::vector<std::string> methods;
  bool reached = false;
  std::vector<std::string> scenes;  // each with its figure
};

// "a, b or c". `last` is the word before the last item.
std::string joined(const std::vector<std::string>& words, const char* last) {
  std::string text;
  for (size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? std::string(" ") + last + " " : ", ";
    text += words[i];
  }
  return text;
}

// The paragraph for a metric that has a target. Scenes with a single series are left out, as nothing is compared there,
// and so are scenes without a value at the end: their images are too small for the metric.
std::string renderMetric(const ConvergenceReport& report, size_t index) {
  const ReportMetric& metric = report.metrics[index];
  // Group scenes by their answer.
  std::vector<Group> groups;
  for (size_t i = 0; i < report.scenes.size(); ++i) {
    const ReportScene& scene = report.scenes[i];
    if (scene.series.size() < 2) continue;
    const SceneAnswer answer = answerFor(scene, metric, index);
    if (!answer.reached && std::isnan(bestFinalValue(scene, metric, index))) continue;
    auto group = std::find_if(groups.begin(), groups.end(), [&](const Group& known) {
      return known.reached == answer.reached && known.methods == answer.methods;
    });
    if (group == groups.end()) group = groups.insert(groups.end(), {answer.methods, answer.reached, {}});
    group->scenes.push_back(
        fmt::format("<a href=\"#scene-{}\">{}</a> ({})", i, escapeHtml(scene.name), escapeHtml(answer.figure)));
  }
  if (groups.empty()) return "";
  // The choice that serves most scenes comes first, scenes without an answer last.
  std::stable_sort(groups.begin(), groups.end(), [](const Group& a, const Group& b) {
    return a.reached != b.reached ? a.reached : a.scenes.size() > b.scenes.size();
  });
  // Write the groups as parts of one sentence.
  std::string html = fmt::format("<p class=\"answer\">First to {} {}: ", escapeHtml(metric.name), *metric.target);
  bool first = true;
  for (const Group& group : groups) {
    std::vector<std::string> methods;
    for (const std::string& method : group.methods) methods.push_back("<b>" + escapeHtml(method) + "</b>");
    if (!first) html += "; ";
    first = false;
    if (group.reached) {
      append(html, "{} in {}", joined(methods, "or"), joined(group.scenes, "and"));
    } else {
      append(html, "none in {}, where {} came closest", joined(group.scenes, "and"), joined(methods, "or"));
    }
  }
  return html + ".</p>\n";
}

}  // namespace

SceneAnswer answerFor(const ReportScene& scene, const ReportMetric& metric, size_t metricIndex) {
  // Order series: those that reach the target by time, then the others by their score at the end.
  struct Candidate {
    const ReportSeries* series;
    std::optional<TargetTime> time;
    double value;
  };
  std::vector<Candidate> all;
  for (const ReportSeries& series : scene.series) {
    all.push_back({&series, timeToReach(series, metric, metricIndex, *metric.target), finalValue(series, metricIndex)});
  }
  std::stable_sort(all.begin(), all.end(), [&](const Candidate& a, const Candidate& b) {
    if (a.time.has_value() != b.time.has_value()) return a.time.has_value();
    if (a.time) return a.time->seconds < b.time->seconds;
    return isBetter(metric, a.value, b.value);
  });
  // The first one is the answer, or came closest.
  SceneAnswer answer;
  if (all.empty()) return answer;
  const Candidate& first = all.front();
  answer.methods = {first.series->label};
  answer.reached = first.time.has_value();
  answer.figure = first.time ? formatTime(*first.time) : formatScore(metric, first.value);
  // Against a noisy reference not even an image without error reaches the target, or hardly.
  const std::optional<double> floor = noiseFloorOf(scene, metricIndex);
  if (!first.time && isNearFloor(metric, *metric.target, floor)) {
    answer.figure += fmt::format("; the reference allows {}", formatScore(metric, *floor));
  } else if (const auto ahead = timeAhead(*first.series, metric, metricIndex, *metric.target, floor)) {
    answer.figure += "; " + formatTimeAhead(*ahead);
  }
  if (!first.time || isClearlyFastest(scene, *first.series, metric, metricIndex, *metric.target)) return answer;
  // Noise leaves the order of the fastest open: add the methods whose times are level with the first.
  for (size_t i = 1; i < all.size(); ++i) {
    if (all[i].time && all[i].time->seconds <= kLevel * first.time->seconds) {
      answer.methods.push_back(all[i].series->label);
    }
  }
  return answer;
}

std::string renderAnswer(const ConvergenceReport& report) {
  std::string html;
  for (size_t m = 0; m < report.metrics.size(); ++m) {
    if (report.metrics[m].target) html += renderMetric(report, m);
  }
  return html;
}

}  // namespace wavecrest
