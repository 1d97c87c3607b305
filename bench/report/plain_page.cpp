#include "bench/report/plain_page.h"

#include "bench/report/assets.h"
#include "bench/report/html_text.h"

namespace wavecrest {

std::string pageHead(std::string_view title, std::string_view css) {
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n";
  append(html, "<title>{}</title>\n<style>\n{}{}{}</style></head>\n<body>\n", escapeHtml(title), kPlotCss, kReportCss,
         css);
  return html;
}

std::string plainPage(std::string_view title, std::string_view sections) {
  std::string html = pageHead(title);
  append(html, "<header><h1>{}</h1></header>\n<main>\n{}</main></body></html>\n", escapeHtml(title), sections);
  return html;
}

}  // namespace wavecrest
