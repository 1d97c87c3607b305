#include "bench/live/campaign_view.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/json_text.h"
#include "bench/live/live_page.h"
#include "bench/report/method_style.h"
#include "metrics/metric_list.h"

namespace wavecrest {
namespace {

using Json = nlohmann::ordered_json;

// Metrics by which curves may be drawn, as campaigns measure them: name of their main score, symbol, and which way is
// better.
Json metricsJson() {
  Json metrics = Json::array();
  for (const Metric& metric : metricList()) {
    if (!metric.byDefault) continue;
    metrics.push_back({{"name", scoreName(metric, metric.score)},
                       {"symbol", metric.symbol},
                       {"title", metric.title},
                       {"higher_is_better", metric.higherIsBetter}});
  }
  return metrics;
}

// The event that describes the campaign. Every event is an object with one key, which names its kind.
Json campaignJson(const CampaignSettings& settings) {
  Json scenes = Json::array(), methods = Json::array();
  for (const CampaignScene& scene : settings.scenes) scenes.push_back(scene.name);
  for (const CampaignMethod& method : settings.methods) {
    methods.push_back({{"id", method.name()}, {"name", methodStyle(method.name()).name}});
  }
  return {{"campaign",
           {{"scenes", scenes},
            {"methods", methods},
            {"seeds", settings.seeds},
            {"width", settings.size[0]},
            {"height", settings.size[1]},
            {"shard", settings.shard.index},
            {"shards", settings.shard.count},
            {"metrics", metricsJson()}}}};
}

}  // namespace

CampaignView::CampaignView(const HostPort& address, const CampaignSettings& settings)
    : server_(address, campaignViewPage()) {
  // Readers get all events in order, so the page learns of the campaign before any run.
  server_.publish(jsonText(campaignJson(settings)));
}

void CampaignView::showEarlier(const CampaignResults& results) {
  for (const RunRecord& run : results.runs) publishRun(run);
}

void CampaignView::showPlan(const CampaignPlan& plan) {
  // The time left is that of runs and of references that are to be rendered.
  server_.publish(jsonText(Json{{"plan",
                                 {{"runs", plan.runs},
                                  {"done", plan.done},
                                  {"seconds_left", plan.renderSeconds + plan.referenceSeconds},
                                  {"unreferenced", plan.unreferenced}}}}));
}

void CampaignView::publishRun(const RunRecord& run) {
  // The points of the run's curves, with all metrics. JSON has no NaN: a value that was not measured is null.
  Json points = Json::array();
  for (const SnapshotRecord& snapshot : run.snapshots) {
    Json values = Json::object();
    for (const auto& [name, value] : snapshot.values) values[name] = std::isfinite(value) ? Json(value) : Json();
    points.push_back({{"number", snapshot.number},
                      {"seconds", snapshot.renderSeconds},
                      {"iterations", snapshot.iterations},
                      {"values", values}});
  }
  server_.publish(jsonText(Json{{"run",
                                 {{"scene", run.scene},
                                  {"method", run.method},
                                  {"seed", run.seed},
                                  {"state", toString(run.state)},
                                  {"reason", run.reason},
                                  {"points", points}}}}));
}

void CampaignView::showRun(const RunRecord& run, const CampaignProgress& progress) {
  // The page adds the run to its curves, then shows what is left.
  publishRun(run);
  server_.publish(jsonText(Json{
      {"progress", {{"done", progress.done}, {"total", progress.total}, {"seconds_left", progress.secondsLeft}}}}));
}

void CampaignView::showEnd(bool complete) { server_.publish(jsonText(Json{{"end", {{"complete", complete}}}})); }

}  // namespace wavecrest
