#include "bench/live/live_page.h"

#include "bench/live/assets.h"
#include "bench/report/html_text.h"
#include "bench/report/plain_page.h"

namespace wavecrest {
namespace {

std::string page(std::string_view title, std::string_view body, std::string_view script) {
  std::string html = pageHead(title);
  append(html, "<style>\n{}</style>\n{}<script>\n{}{}</script>\n</body></html>\n", kLiveCss, body, kLiveJs, script);
  return html;
}

}  // namespace

std::string renderViewPage() { return page("wavecrest render", kRenderViewHtml, kRenderViewJs); }
std::string campaignViewPage() { return page("wavecrest converge", kCampaignViewHtml, kCampaignViewJs); }

}  // namespace wavecrest
