#include "engine/load/sun_position.h"

#include <cmath>
#include <numbers>

namespace wavecrest {

namespace {

constexpr double kDegree = std::numbers::pi / 180;

// Days from noon of 1 January 2000, universal time (Fliegel and Van Flandern 1968: Julian day of a Gregorian date).
double daysSince2000(const PlaceAndTime& at, double universalHours) {
  const int toMarch = (at.month - 14) / 12;
  const int day = 1461 * (at.year + 4800 + toMarch) / 4 + 367 * (at.month - 2 - 12 * toMarch) / 12 -
                  3 * ((at.year + 4900 + toMarch) / 100) / 4 + at.day - 32075;
  return day - 0.5 + universalHours / 24 - 2451545;
}

}  // namespace

SunPosition sunPosition(const PlaceAndTime& at) {
  const double hours = at.hour - at.timezone + (at.minute + at.second / 60) / 60;
  const double days = daysSince2000(at, hours);

  // Ecliptic coordinates.
  const double omega = 2.1429 - 0.0010394594 * days;
  const double meanLongitude = 4.8950630 + 0.017202791698 * days, anomaly = 6.2400600 + 0.0172019699 * days;
  const double longitude = meanLongitude + 0.03341607 * std::sin(anomaly) + 0.00034894 * std::sin(2 * anomaly) -
                           0.0001134 - 0.0000203 * std::sin(omega);
  const double obliquity = 0.4090928 - 6.2140e-9 * days + 0.0000396 * std::cos(omega);

  // Celestial coordinates.
  const double rightAscension = std::atan2(std::cos(obliquity) * std::sin(longitude), std::cos(longitude));
  const double declination = std::asin(std::sin(obliquity) * std::sin(longitude));

  // Local coordinates, with the parallax of a place on the earth's surface.
  const double siderealHours = 6.6974243242 + 0.0657098283 * days + hours;
  const double hourAngle = (siderealHours * 15 + at.longitude) * kDegree - rightAscension;
  const double latitude = at.latitude * kDegree;
  const double zenith = std::acos(std::cos(latitude) * std::cos(hourAngle) * std::cos(declination) +
                                  std::sin(declination) * std::sin(latitude));
  const double azimuth = std::atan2(
      -std::sin(hourAngle), std::tan(declination) * std::cos(latitude) - std::sin(latitude) * std::cos(hourAngle));
  constexpr double kEarthRadius = 6371.01, kAstronomicalUnit = 149597890;  // km
  return {zenith + kEarthRadius / kAstronomicalUnit * std::sin(zenith), azimuth};
}

}  // namespace wavecrest
