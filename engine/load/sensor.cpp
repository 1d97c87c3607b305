#include "engine/load/sensor.h"

#include "engine/load/film.h"
#include "engine/load/perspective.h"
#include "engine/load/plugins.h"

namespace wavecrest {

namespace {

void readCommon(Parameters& parameters, Sensor& sensor) {
  sensor.toWorld = parameters.transform("to_world").value_or(identityMatrix());
  sensor.nearClip = parameters.positiveReal("near_clip", 1e-2);
  sensor.farClip = parameters.positiveReal("far_clip", 1e4);
  if (sensor.nearClip >= sensor.farClip) {
    throw LoadError(parameters.locationOf("near_clip"),
                    "near_clip is not below far_clip; expected near_clip < far_clip");
  }
  sensor.focusDistance = parameters.positiveReal("focus_distance", sensor.farClip);
  const double open = parameters.real("shutter_open", 0), close = parameters.real("shutter_close", 0);
  if (close < open) {
    throw LoadError(parameters.locationOf("shutter_close"), "shutter_close is before shutter_open; expected it later");
  }
}

}  // namespace

void readPerspective(Parameters& parameters, Sensor& sensor) {
  sensor.kind = Sensor::Kind::perspective;
  sensor.principalPointOffset = {parameters.real("principal_point_offset_x", 0),
                                 parameters.real("principal_point_offset_y", 0)};
}

void readThinLens(Parameters& parameters, Sensor& sensor) {
  sensor.kind = Sensor::Kind::thinlens;
  sensor.apertureRadius = parameters.requiredReal("aperture_radius");
  if (!(sensor.apertureRadius >= 0)) {
    throw LoadError(parameters.locationOf("aperture_radius"), "aperture_radius is negative; expected 0 or more");
  }
}

void readOrthographic(Parameters&, Sensor& sensor) { sensor.kind = Sensor::Kind::orthographic; }

void readSensor(LoadContext& context, const XmlElement& element) {
  const SensorPlugin* plugin = findPlugin(context, sensorPlugins(), element, "read as perspective");
  if (!plugin) plugin = &sensorPlugins().front();
  Parameters parameters(context, element);
  Sensor& sensor = context.scene.sensor;
  readCommon(parameters, sensor);
  plugin->read(parameters, sensor);

  const std::vector<const XmlElement*> films = parameters.objects("film"), samplers = parameters.objects("sampler");
  if (films.size() > 1 || samplers.size() > 1) {
    throw LoadError(parameters.location(), "sensor has more than one film or sampler; expected at most one of each");
  }
  readFilm(context, films.empty() ? nullptr : films.front());
  readSampler(context, samplers.empty() ? nullptr : samplers.front());

  if (sensor.kind == Sensor::Kind::orthographic) {
    parameters.ignore({"fov", "fov_axis", "focal_length"});
    checkPerpendicular(sensor.toWorld, "the sensor", parameters.locationOf("to_world"));
  } else {
    checkRigid(sensor.toWorld, "the sensor", parameters.locationOf("to_world"));
    const FilmSettings& film = context.scene.film;
    sensor.fovX = readHorizontalFov(parameters, static_cast<double>(film.width) / film.height);
  }
  parameters.finish();
}

}  // namespace wavecrest
