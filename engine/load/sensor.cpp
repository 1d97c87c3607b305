#include "engine/load/sensor.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/load/film.h"
#include "engine/load/plugins.h"
#include "engine/load/values.h"

namespace wavecrest {

namespace {

// How the field of view is given; it needs the film's aspect ratio to become horizontal.
struct FieldOfView {
  double degrees = 0;
  std::string axis;
  SourceLocation where;
};

double toRadians(double degrees) { return degrees * (std::numbers::pi / 180); }
double toDegrees(double radians) { return radians * (180 / std::numbers::pi); }

FieldOfView readFieldOfView(Parameters& parameters) {
  FieldOfView fov{.axis = toLower(parameters.string("fov_axis", "x")), .where = parameters.location()};
  const bool hasFov = parameters.has("fov"), hasFocalLength = parameters.has("focal_length");
  if (hasFov && hasFocalLength) {
    throw LoadError(parameters.locationOf("focal_length"), "sensor has fov and focal_length; expected one of the two");
  }
  if (hasFov) {
    fov.degrees = parameters.requiredReal("fov");
    fov.where = parameters.locationOf("fov");
    return fov;
  }
  // A focal length refers to the diagonal of 35 mm film, 36 x 24 mm.
  std::string text = parameters.string("focal_length", "50mm");
  fov.where = parameters.locationOf("focal_length");
  if (text.ends_with("mm")) text.resize(text.size() - 2);
  const double focalLength = parseReal(text, fov.where);
  if (!(focalLength > 0)) throw LoadError(fov.where, "focal_length is not positive; expected for example 50mm");
  fov.degrees = 2 * toDegrees(std::atan(std::hypot(36.0, 24.0) / (2 * focalLength)));
  fov.axis = "diagonal";
  return fov;
}

double horizontalFov(const FieldOfView& fov, const FilmSettings& film) {
  const double aspect = static_cast<double>(film.width) / film.height;
  std::string axis = fov.axis;
  if (axis == "smaller") axis = aspect > 1 ? "y" : "x";
  if (axis == "larger") axis = aspect > 1 ? "x" : "y";
  if (!(fov.degrees > 0) || !(fov.degrees < 180)) {
    throw LoadError(fov.where,
                    "field of view is " + std::to_string(fov.degrees) + "; expected degrees between 0 and 180");
  }
  const double halfSize = std::tan(0.5 * toRadians(fov.degrees));
  if (axis == "x") return fov.degrees;
  if (axis == "y") return 2 * toDegrees(std::atan(halfSize * aspect));
  if (axis == "diagonal") return 2 * toDegrees(std::atan(halfSize / std::sqrt(1 + 1 / (aspect * aspect))));
  throw LoadError(fov.where, "unknown fov_axis " + inQuotes(axis) + "; expected x, y, diagonal, smaller or larger");
}

// Rotation and translation, with unit axes: Mitsuba refuses any scale.
void checkRigid(const Matrix4& m, const SourceLocation& where) {
  constexpr double kTolerance = 1e-3;
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = i; j < 3; ++j) {
      double product = 0;
      for (size_t k = 0; k < 3; ++k) product += m[i][k] * m[j][k];
      if (std::abs(product - (i == j ? 1 : 0)) > kTolerance) {
        throw LoadError(where, "to_world of the sensor scales or shears; expected rotation and translation");
      }
    }
  }
}

// Axes that are perpendicular, of any length but none: the picture of an orthographic camera may be scaled, not
// sheared.
void checkPerpendicular(const Matrix4& m, const SourceLocation& where) {
  constexpr double kTolerance = 1e-6;
  const auto product = [&](size_t i, size_t j) { return m[0][i] * m[0][j] + m[1][i] * m[1][j] + m[2][i] * m[2][j]; };
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = i; j < 3; ++j) {
      const bool perpendicular = std::abs(product(i, j)) <= kTolerance * std::sqrt(product(i, i) * product(j, j));
      if (i == j ? !(product(i, i) > 0) : !perpendicular) {
        throw LoadError(where, "to_world of the sensor shears or flattens; expected rotation, translation and scale");
      }
    }
  }
}

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
    checkPerpendicular(sensor.toWorld, parameters.locationOf("to_world"));
  } else {
    checkRigid(sensor.toWorld, parameters.locationOf("to_world"));
    sensor.fovX = horizontalFov(readFieldOfView(parameters), context.scene.film);
  }
  parameters.finish();
}

}  // namespace wavecrest
