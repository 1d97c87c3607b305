// The scores of several machines for a terminal, as a page and as JSON.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <span>

#include "bench/enumerator_name.h"
#include "bench/report/html_text.h"
#include "bench/report/plain_page.h"
#include "bench/score/machine_scores.h"
#include "bench/score/score.h"
#include "bench/text_lines.h"

namespace wavecrest {
namespace {

constexpr const char* kMeaning =
    "Geometric means over a fixed workload; 100 is one core of the reference machine. A core's score is that of one "
    "thread, and says how fast cores are that share nothing.";

// Whether its figures stand beside others'.
bool counts(const MachineScore& score) { return score.refusal.empty() && score.whole; }

// How the images were accepted, or why the score does not count.
std::string imagesOf(const MachineScore& score) {
  if (!score.refusal.empty()) return score.refusal;
  std::string text =
      score.tolerated == 0 ? "exact" : fmt::format("{} of {} by tolerance", score.tolerated, score.entries);
  if (!score.whole) text += fmt::format("; {} of {} entries", score.entries, workloadOf(score.size).size());
  return text;
}

std::string figure(const MachineScore& score, double value) {
  return counts(score) ? fmt::format("{:.0f}", value) : "\u2013";
}

// Calls function(size, scores of it) for each size that has scores.
template <class Function>
void forEachSize(const std::vector<MachineScore>& scores, Function&& function) {
  for (size_t begin = 0, end; begin < scores.size(); begin = end) {
    end = begin;
    while (end < scores.size() && scores[end].size == scores[begin].size) ++end;
    function(enumeratorName(kScoreSizeNames, scores[begin].size), std::span(scores).subspan(begin, end - begin));
  }
}

std::string threadsInWords(const MachineScore& score) {
  return fmt::format("{} thread{}", score.threads, score.threads == 1 ? "" : "s");
}

// The head of a table of machines, up to their threads.
constexpr std::string_view kMachineColumns =
    "<div class=\"scroll\"><table><thead><tr><th>machine<th class=\"n\">threads";
constexpr std::string_view kTableEnd = "</tbody></table></div>\n";

std::string scoreTable(std::span<const MachineScore> scores) {
  std::string html(kMachineColumns);
  html += "<th class=\"n\">score<th class=\"n\">per thread<th class=\"n\">a core<th>instructions</thead><tbody>";
  for (const MachineScore& score : scores) {
    append(html, "<tr><th>{}<td class=\"n\">{}<td class=\"n\">{}<td class=\"n\">{}<td class=\"n\">{}<td>{}",
           escapeHtml(score.machine), score.threads, figure(score, score.score),
           figure(score, score.score / score.threads), figure(score, score.coreScore), escapeHtml(score.isa));
  }
  return html.append(kTableEnd);
}

// What each score rests on. A list, because the texts are too long for a table on a narrow screen.
std::string basis(std::span<const MachineScore> scores) {
  std::string html = "<h3>Images, builds and doubts</h3>\n<ul>\n";
  for (const MachineScore& score : scores) {
    append(html, "<li>{}, {}: {}; {}", escapeHtml(score.machine), threadsInWords(score), escapeHtml(imagesOf(score)),
           escapeHtml(score.build));
    for (const std::string& doubt : score.doubts) append(html, "<br><small>doubt: {}</small>", escapeHtml(doubt));
    html += "\n";
  }
  return html + "</ul>\n";
}

// A column for each method that any of them has measured.
std::string methodTable(std::span<const MachineScore> scores) {
  std::set<std::string> methods;
  for (const MachineScore& score : scores) {
    for (const auto& [method, value] : score.methods) methods.insert(method);
  }
  std::string html(kMachineColumns);
  for (const std::string& method : methods) append(html, "<th class=\"n\">{}", escapeHtml(method));
  html += "</thead><tbody>";
  for (const MachineScore& score : scores) {
    append(html, "<tr><th>{}<td class=\"n\">{}", escapeHtml(score.machine), score.threads);
    for (const std::string& method : methods) {
      const auto found = score.methods.find(method);
      append(html, "<td class=\"n\">{}", found == score.methods.end() ? "\u2013" : figure(score, found->second));
    }
  }
  return html.append(kTableEnd);
}

// Paths per second: a row for each entry, and a column for each machine that counts.
std::string rateTable(std::span<const MachineScore> scores) {
  std::set<std::string> entries;
  std::string html = "<div class=\"scroll\"><table><thead><tr><th>scene, method";
  for (const MachineScore& score : scores) {
    if (!counts(score)) continue;
    append(html, "<th class=\"n\">{}, {}", escapeHtml(score.machine), threadsInWords(score));
    for (const auto& [entry, rate] : score.rates) entries.insert(entry);
  }
  html += "</thead><tbody>";
  for (const std::string& entry : entries) {
    append(html, "<tr><th>{}", escapeHtml(entry));
    for (const MachineScore& score : scores) {
      // Machines that count have the same entries.
      if (counts(score)) append(html, "<td class=\"n\">{}", formatCount(score.rates.at(entry)));
    }
  }
  return html.append(kTableEnd);
}

}  // namespace

std::string machinesText(const std::vector<MachineScore>& scores) {
  TextLines text;
  forEachSize(scores, [&](std::string_view size, std::span<const MachineScore> all) {
    line(text, "{}", size);
    line(text, "  {:<40} {:>7} {:>8} {:>8}  {:<8} {}", "machine", "threads", "score", "a core", "isa", "images");
    for (const MachineScore& score : all) {
      line(text, "  {:<40} {:>7} {:>8} {:>8}  {:<8} {}", score.machine, score.threads, figure(score, score.score),
           figure(score, score.coreScore), score.isa, imagesOf(score));
      for (const std::string& doubt : score.doubts) line(text, "    doubt: {}", doubt);
    }
  });
  line(text, "\n{}", kMeaning);
  return fmt::to_string(text);
}

std::string machinesPage(const std::vector<MachineScore>& scores) {
  std::string sections;
  forEachSize(scores, [&](std::string_view size, std::span<const MachineScore> all) {
    append(sections, "<section><h2>bench --score {}</h2>\n", size);
    sections += scoreTable(all);
    append(sections, "<p class=\"facts\">{}</p>\n", kMeaning);
    sections += basis(all) + "<h3>Scores by method, all threads</h3>\n" + methodTable(all);
    if (std::ranges::any_of(all, counts)) {
      sections += "<details><summary>Paths per second, all threads</summary>\n" + rateTable(all) + "</details>\n";
    }
    sections += "</section>\n";
  });
  return plainPage("wavecrest on several machines", sections);
}

nlohmann::ordered_json machinesJson(const std::vector<MachineScore>& scores) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const MachineScore& score : scores) {
    rows.push_back({{"cpu", score.machine},
                    {"threads", score.threads},
                    {"size", enumeratorName(kScoreSizeNames, score.size)},
                    {"isa", score.isa},
                    {"build", score.build},
                    {"score", score.score},
                    {"core_score", score.coreScore},
                    {"method_scores", score.methods},
                    {"counts", counts(score)},
                    {"images", imagesOf(score)},
                    {"doubts", score.doubts}});
  }
  return {{"scores", rows}};
}

}  // namespace wavecrest
