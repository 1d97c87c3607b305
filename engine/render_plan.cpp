#include "engine/render_plan.h"

#include <stdexcept>
#include <string>

namespace wavecrest {
namespace {

ColumnNeeds columnNeeds(Specialization specialization) {
  const uint32_t features = featuresOf(specialization);
  return {.shadingNormals = (features & kShadingNormals) != 0,
          .textures = (features & kTextures) != 0,
          .rouletteScale = (features & (kSpecularBsdfs | kBidirectional)) != 0,
          .connections = (features & kBidirectional) != 0};
}

Specialization specializationFor(const Scene& scene, const RenderSettings& settings) {
  const uint32_t features = sceneFeatures(scene) | (entryOf(settings.method).bidirectional ? kBidirectional : 0u);
  const Specialization least = chooseSpecialization(features, settings.precision);
  if (!settings.specialization) return least;
  if ((features & ~featuresOf(*settings.specialization)) != 0) {
    throw std::runtime_error("scene and method need the '" +
                             std::string(kSpecializationNames[static_cast<size_t>(least)]) + "' kernels");
  }
  return chooseSpecialization(featuresOf(*settings.specialization), settings.precision);
}

}  // namespace

template <class S>
RenderPlan<S> planRender(const Scene& scene, const RenderSettings& settings) {
  RenderPlan<S> plan;
  plan.specialization = specializationFor(scene, settings);
  plan.needs = columnNeeds(plan.specialization);
  plan.scene = compileScene<S>(scene, settings.accel);
  const Stages<S>& stages = findStages<S>(settings.isa, settings.precision, plan.specialization);
  plan.isa = stages.isa;
  const Intersector<S> intersector = plan.accel() == Accel::small
                                         ? Intersector<S>{stages.extendSmall, stages.occludeSmall, stages.lanes}
                                         : Intersector<S>{extendEmbree<S>, occludeEmbree<S>, kEmbreePacket};
  plan.pipeline = makePipeline(settings.method, stages, intersector);
  return plan;
}
template RenderPlan<float> planRender(const Scene&, const RenderSettings&);
template RenderPlan<double> planRender(const Scene&, const RenderSettings&);

FilmArea filmArea(const FilmSettings& film) {
  if (film.cropWidth == 0 || film.cropHeight == 0) return FilmArea::make(0, 0, film.width, film.height);
  return FilmArea::make(film.cropX, film.cropY, film.cropWidth, film.cropHeight);
}

}  // namespace wavecrest
