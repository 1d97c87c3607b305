#include "bench/campaign/run_settings.h"

namespace wavecrest {

std::vector<CampaignMethod> methodsOfShard(const CampaignSettings& settings, size_t scene) {
  std::vector<CampaignMethod> methods;
  for (size_t i = 0; i < settings.methods.size(); ++i) {
    const size_t group = scene * settings.methods.size() + i;
    if (group % settings.shard.count == settings.shard.index - 1) methods.push_back(settings.methods[i]);
  }
  return methods;
}

RenderSettings runSettings(const CampaignSettings& settings, const CampaignScene& entry, const Scene& scene,
                           const CampaignMethod& method, uint64_t seed) {
  RenderSettings render = settings.render;
  render.method = method.method;
  if (method.automatic) {
    takeProgramDefaults(render);
    render.radiusAlpha = RenderSettings().radiusAlpha;
    render.lightPaths.reset();
  }
  render.samplerIsChosen = !method.automatic && settings.sampler.has_value();
  render.sampler = method.automatic ? bestSampler(render) : settings.sampler.value_or(bestSampler(render));
  render.metropolis.variant = method.variant;
  render.directPass = method.directPass;
  if (!strategiesOf(method.method).merge) render.lightPaths.reset();
  render.seed = seed;
  render.limits = pathLimits(scene.defaults.maxDepth, scene.defaults.rrDepth);
  render.measureStages = true;
  render.iterations = settings.iterations;
  if (!settings.iterations) render.seconds = entry.effort.seconds;
  return render;
}

SnapshotSchedule snapshotSchedule(const CampaignSettings& settings, const CampaignScene& entry) {
  if (settings.iterations) return SnapshotSchedule::doubling();
  const double interval = entry.effort.snapshotSeconds;
  if (!(interval > 0)) return SnapshotSchedule::logarithmic();
  return entry.effort.logarithmicFirst ? SnapshotSchedule::logarithmicThenEvery(interval)
                                       : SnapshotSchedule::every(interval);
}

}  // namespace wavecrest
