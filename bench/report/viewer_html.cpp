#include "bench/report/viewer_html.h"

#include <fmt/format.h>

#include "bench/report/html_text.h"

namespace wavecrest {

std::string viewerPane(const ViewerPane& pane) {
  const std::string floats = pane.floats.empty()
                                 ? ""
                                 : fmt::format(" data-floats=\"{}\" data-width=\"{}\" data-height=\"{}\"",
                                               escapeHtml(pane.floats), pane.width, pane.height);
  return fmt::format(
      "<figure class=\"pane\" data-name=\"{}\"{}><div class=\"frame\"><img src=\"{}\" width=\"{}\" height=\"{}\" "
      "alt=\"{}\"></div><figcaption>{}</figcaption></figure>\n",
      escapeHtml(pane.name), floats, pane.uri, pane.width, pane.height, escapeHtml(pane.label), escapeHtml(pane.label));
}

std::string viewerGroup(std::string_view kind, std::string_view head, std::string_view panes, std::string_view step) {
  const std::string earlier = step.empty() ? "" : fmt::format(" data-step=\"{}\"", escapeHtml(step));
  std::string html = fmt::format("<div class=\"panes\" data-kind=\"{}\"{}>\n", escapeHtml(kind), earlier);
  if (!head.empty()) append(html, "<div class=\"facts head\">{}</div>\n", head);
  append(html, "{}</div>\n", panes);
  return html;
}

std::string viewer(std::string_view groups, std::span<const PictureCrop> crops, double exposure) {
  std::string words;
  for (const PictureCrop& crop : crops) {
    append(words, "{}{},{},{}x{}", words.empty() ? "" : " ", crop.x, crop.y, crop.width, crop.height);
  }
  std::string data = words.empty() ? "" : fmt::format(" data-crops=\"{}\"", words);
  if (exposure != 0) append(data, " data-exposure=\"{}\"", exposure);
  return fmt::format("<div class=\"viewer\"{}>{}</div>\n", data, groups);
}

std::string colourBar(double range) {
  return fmt::format("<span class=\"scale\"><i></i><b><span>0</span><span>{}</span><span>{} and more</span></b></span>",
                     formatSignificant(range / 2), formatSignificant(range));
}

}  // namespace wavecrest
