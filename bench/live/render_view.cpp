#include "bench/live/render_view.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/json_text.h"
#include "bench/live/live_page.h"

namespace wavecrest {

using Json = nlohmann::ordered_json;

RenderView::RenderView(const HostPort& address, const Json& facts, const Goal& goal)
    : goal_(goal), server_(address, renderViewPage()) {
  server_.publish(jsonText(Json{{"facts", facts}}));
}

void RenderView::take(const std::shared_ptr<const Look>& look) {
  // The rate since the last look, so that the curve shows where something else took the machine's time.
  const double seconds = look->renderSeconds - seconds_;
  Json event{{"seconds", look->renderSeconds}, {"iterations", look->iterations}, {"paths", look->paths}};
  event["paths_per_second"] = seconds > 0 ? Json(static_cast<double>(look->paths - paths_) / seconds) : Json();
  paths_ = look->paths;
  seconds_ = look->renderSeconds;
  double done = 0;
  if (goal_.seconds > 0) done = std::max(done, look->renderSeconds / goal_.seconds);
  if (goal_.iterations > 0) {
    done = std::max(done, static_cast<double>(look->iterations) / static_cast<double>(goal_.iterations));
  }
  event["fraction"] = goal_.seconds > 0 || goal_.iterations > 0 ? Json(std::min(done, 1.0)) : Json();
  if (look->error) {
    event["error"] = {{"iterations", look->errorIterations},
                      {"value", look->error->value},
                      {"low", look->error->interval.low},
                      {"high", look->error->interval.high}};
  }
  event["last"] = look->last;
  server_.setImage({look, &look->image});  // the look lives as long as the image
  server_.publish(jsonText(event));
}

}  // namespace wavecrest
