// The emitters `sunsky` of Mitsuba 3, and `sunsky`, `sky` and `sun` of 0.5 and 0.6: one kind of light in the scene.
//
// Mitsuba 3's sky has its zenith along z, with azimuths counter-clockwise seen from above; that of 0.6 along y,
// clockwise.
#include <algorithm>
#include <cmath>

#include "engine/load/color.h"
#include "engine/load/emitters.h"
#include "engine/load/sun_position.h"
#include "engine/load/values.h"
#include "engine/scene/vector_math.h"

namespace wavecrest {

namespace {

constexpr double kSunAperture = 0.5358;  // degrees, Mitsuba's
// Directions in float are too coarse for a much smaller sun: many of those sampled in its disc would round to outside
// of it. A sun of this size already looks like a point. Its irradiance does not depend on its size.
constexpr double kSmallestAperture = 0.02;

int readWhole(Parameters& parameters, std::string_view name, int fallback, int lowest, int highest) {
  return static_cast<int>(parameters.integer(name, fallback, lowest, highest));
}

// What is absent keeps the defaults of PlaceAndTime.
PlaceAndTime readPlaceAndTime(Parameters& parameters) {
  PlaceAndTime at;
  at.latitude = parameters.real("latitude", at.latitude);
  at.longitude = parameters.real("longitude", at.longitude);
  at.timezone = parameters.real("timezone", at.timezone);
  at.year = readWhole(parameters, "year", at.year, -4000, 10'000);
  at.month = readWhole(parameters, "month", at.month, 1, 12);
  at.day = readWhole(parameters, "day", at.day, 1, 31);
  at.hour = parameters.real("hour", at.hour);
  at.minute = parameters.real("minute", at.minute);
  at.second = parameters.real("second", at.second);
  return at;
}

// Unit, towards the sun, in the world.
Double3 readSunDirection(Parameters& parameters, const Matrix4& toWorld, bool legacy) {
  // A direction excludes a place and a time.
  if (const std::optional<Double3> direction = parameters.vector("sun_direction")) {
    for (const char* name : {"latitude", "longitude", "timezone", "year", "month", "day", "hour", "minute", "second"}) {
      if (!parameters.has(name)) continue;
      throw LoadError(parameters.locationOf(name),
                      inQuotes(name) + " is given beside sun_direction; expected the direction, or place and time");
    }
    if (!(length(*direction) > 0)) {
      throw LoadError(parameters.locationOf("sun_direction"),
                      "\"sun_direction\" has no direction; expected a vector of positive length");
    }
    return normalized(*direction);
  }
  // The direction at a place and time: x points north and y east, before they are turned to the axes of the sky.
  const SunPosition sun = sunPosition(readPlaceAndTime(parameters));
  const double sine = std::sin(sun.zenithAngle), height = std::cos(sun.zenithAngle);
  const double x = std::cos(sun.azimuth) * sine, y = std::sin(sun.azimuth) * sine;
  return normalized(transformVector(toWorld, legacy ? Double3{y, height, -x} : Double3{-x, -y, height}));
}

Rgb readAlbedo(LoadContext& context, Parameters& parameters, double fallback) {
  const XmlElement* const element = parameters.element("albedo");
  if (!element) return {fallback, fallback, fallback};
  if (element->isObject() && element->tag == "texture") {
    throw LoadError(element->location(), "albedo of the ground is a texture; expected one colour");
  }
  const Rgb albedo = readColor(context, *element, ColorRole::reflectance);
  // An object may be above 1.
  if (std::ranges::max(albedo) > 1) {
    throw LoadError(element->location(), "albedo of the ground is above 1; expected values from 0 to 1");
  }
  return albedo;
}

double readScale(Parameters& parameters, std::string_view name, double fallback) {
  const double scale = parameters.real(name, fallback);
  if (!(scale >= 0)) {
    throw LoadError(parameters.locationOf(name), inQuotes(name) + " is negative; expected 0 or more");
  }
  return scale;
}

}  // namespace

EmitterKind readSunsky(LoadContext& context, Parameters& parameters) {
  const bool legacy = parameters.object().legacy;
  const std::string_view type = parameters.object().get("type");
  const Matrix4 toWorld = parameters.transform("to_world").value_or(identityMatrix());
  checkEnvironmentTransform(context, parameters, toWorld);
  SunskyEmitter sky{.turbidity = parameters.real("turbidity", 3),
                    .albedo = readAlbedo(context, parameters, legacy ? 0.2 : 0.3),
                    .sunDirection = readSunDirection(parameters, toWorld, legacy),
                    .toWorld = toWorld};
  if (!(sky.turbidity >= 1 && sky.turbidity <= 10)) {
    throw LoadError(parameters.locationOf("turbidity"),
                    "turbidity is " + std::to_string(sky.turbidity) + "; expected 1 to 10");
  }
  // Factors of sky and sun. A `sun` has no sky, and a `sky` has no sun.
  const double scale = readScale(parameters, "scale", 1);
  if (type != "sun") sky.skyScale = readScale(parameters, "sky_scale", scale);
  if (type != "sky") sky.sunScale = readScale(parameters, "sun_scale", scale);
  if (type == "sun") sky.skyScale = 0;
  if (type == "sky") sky.sunScale = 0;
  // The disc of the sun.
  sky.sunAperture = parameters.positiveReal("sun_aperture", kSunAperture);
  if (sky.sunAperture >= 180) {
    throw LoadError(parameters.locationOf("sun_aperture"), "sun_aperture is not below 180; expected degrees");
  }
  // Versions 0.5 and 0.6 scale it.
  const bool scaled = legacy && parameters.has("sun_radius_scale");
  if (scaled) sky.sunAperture = std::min(sky.sunAperture * readScale(parameters, "sun_radius_scale", 1), 90.0);
  if (sky.sunAperture < kSmallestAperture) {
    context.note(parameters.locationOf(scaled ? "sun_radius_scale" : "sun_aperture"), "sun_aperture below 0.02 degrees",
                 "0.02 is used");
    sky.sunAperture = kSmallestAperture;
  }
  if (parameters.boolean("complex_sun", false)) {
    context.note(
        parameters.locationOf("complex_sun"), "complex_sun",
        "the sun's disc is evenly bright, with the irradiance of Mitsuba's plain sun: a sun below 5 degrees is "
        "too bright");
  }
  // The zenith of versions 0.5 and 0.6 is along y.
  if (legacy) {
    for (size_t i = 0; i < 3; ++i) {  // z up instead of y
      const auto row = toWorld[i];
      sky.toWorld[i] = {row[0], 0 - row[2], row[1], row[3]};  // 0 for 0, where -row[2] is -0
    }
    parameters.ignore({"resolution", "sun_samples"});
    parameters.leaveOut({"stretch", "extend"}, "left out: nothing shines below the horizon");
    context.note(parameters.location(), parameters.describe(), "read with the sun and sky of Mitsuba 3's sunsky");
  }
  if (dot(sky.sunDirection, transformVector(sky.toWorld, {0, 0, 1})) < 0) {
    context.note(parameters.location(), "sun below the horizon", "sun and sky are black");
  }
  return sky;
}

bool joinSunAndSky(EmitterKind& first, const EmitterKind& second) {
  auto* const a = std::get_if<SunskyEmitter>(&first);
  const auto* const b = std::get_if<SunskyEmitter>(&second);
  // The same direction, to within 0.26 degrees.
  if (a == nullptr || b == nullptr || dot(a->sunDirection, b->sunDirection) < 0.99999) return false;
  if (a->turbidity != b->turbidity) return false;
  // Exactly one of the two has a sun only, and the other has a sky only.
  const bool firstIsSun = a->skyScale == 0 && b->sunScale == 0, secondIsSun = a->sunScale == 0 && b->skyScale == 0;
  if (firstIsSun == secondIsSun) return false;
  const SunskyEmitter &sun = firstIsSun ? *a : *b, &sky = firstIsSun ? *b : *a;
  // The sky gets the sun.
  SunskyEmitter both = sky;
  both.sunScale = sun.sunScale;
  both.sunAperture = sun.sunAperture;
  *a = both;
  return true;
}

}  // namespace wavecrest
