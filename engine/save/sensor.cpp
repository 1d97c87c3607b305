#include "engine/save/sections.h"

namespace wavecrest {

namespace {

void saveFilter(pugi::xml_node film, const FilmSettings& settings) {
  const auto kind = static_cast<size_t>(settings.filter);
  const pugi::xml_node node = addObject(film, "rfilter", kFilterNames[kind].data());
  if (settings.filter == ReconstructionFilter::gaussian) return addFloat(node, "stddev", settings.gaussianStddev);
  const double usual = settings.filter == ReconstructionFilter::box ? 0.5 : 1;
  if (settings.filterRadius != usual) addFloat(node, "radius", settings.filterRadius);
}

void saveFilm(pugi::xml_node sensor, const FilmSettings& film) {
  const pugi::xml_node node = addObject(sensor, "film", "hdrfilm");
  addInteger(node, "width", film.width);
  addInteger(node, "height", film.height);
  if (film.isCropped()) {
    addInteger(node, "crop_offset_x", film.cropX);
    addInteger(node, "crop_offset_y", film.cropY);
    addInteger(node, "crop_width", film.cropWidth);
    addInteger(node, "crop_height", film.cropHeight);
  }
  addString(node, "pixel_format", "rgb");
  addString(node, "component_format", "float32");
  saveFilter(node, film);
}

}  // namespace

void saveIntegrator(SaveContext& context) {
  const pugi::xml_node node = addObject(context.root, "integrator", "path");
  addInteger(node, "max_depth", context.scene.defaults.maxDepth);
  addInteger(node, "rr_depth", context.scene.defaults.rrDepth);
  if (context.scene.defaults.hideEmitters) addBoolean(node, "hide_emitters", true);
}

void saveSensor(SaveContext& context) {
  const Sensor& sensor = context.scene.sensor;
  const pugi::xml_node node =
      addObject(context.root, "sensor", Sensor::kKindNames[static_cast<size_t>(sensor.kind)].data());
  addTransform(node, "to_world", sensor.toWorld);
  addFloat(node, "near_clip", sensor.nearClip);
  addFloat(node, "far_clip", sensor.farClip);
  if (sensor.kind != Sensor::Kind::orthographic) {
    addString(node, "fov_axis", "x");
    addFloat(node, "fov", sensor.fovX);
  }
  if (sensor.kind == Sensor::Kind::perspective && sensor.principalPointOffset != std::array<double, 2>{0, 0}) {
    addFloat(node, "principal_point_offset_x", sensor.principalPointOffset[0]);
    addFloat(node, "principal_point_offset_y", sensor.principalPointOffset[1]);
  }
  if (sensor.kind == Sensor::Kind::thinlens) addFloat(node, "aperture_radius", sensor.apertureRadius);
  if (sensor.focusDistance != sensor.farClip) addFloat(node, "focus_distance", sensor.focusDistance);
  saveFilm(node, context.scene.film);
  addInteger(addObject(node, "sampler", "independent"), "sample_count", context.scene.defaults.sampleCount);
}

}  // namespace wavecrest
