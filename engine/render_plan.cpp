#include "engine/render_plan.h"

#include <stdexcept>
#include <string>

namespace wavecrest {
namespace {

ColumnNeeds columnNeeds(Specialization specialization) {
  const uint32_t features = kSpecializationFeatures[static_cast<size_t>(specialization)];
  return {.shadingNormals = (features & kShadingNormals) != 0,
          .textures = (features & kTextures) != 0,
          .refraction = (features & kSpecularBsdfs) != 0,
          .connections = false};
}

Specialization specializationFor(const Scene& scene, const RenderSettings& settings) {
  const uint32_t features = sceneFeatures(scene);
  const Specialization least = chooseSpecialization(features);
  if (!settings.specialization) return least;
  if ((features & ~kSpecializationFeatures[static_cast<size_t>(*settings.specialization)]) != 0) {
    throw std::runtime_error("the scene needs the '" + std::string(kSpecializationNames[static_cast<size_t>(least)]) +
                             "' kernels");
  }
  return *settings.specialization;
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
  plan.pipeline = pathTracing(stages, plan.accel() == Accel::small
                                          ? Intersector<S>{stages.extendSmall, stages.occludeSmall, stages.lanes}
                                          : Intersector<S>{extendEmbree<S>, occludeEmbree<S>, kEmbreePacket});
  return plan;
}
template RenderPlan<float> planRender(const Scene&, const RenderSettings&);
template RenderPlan<double> planRender(const Scene&, const RenderSettings&);

FilmArea filmArea(const FilmSettings& film) {
  if (film.cropWidth == 0 || film.cropHeight == 0) return FilmArea::make(0, 0, film.width, film.height);
  return FilmArea::make(film.cropX, film.cropY, film.cropWidth, film.cropHeight);
}

}  // namespace wavecrest
