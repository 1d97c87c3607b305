// Where the sun stands at a place and time.
#pragma once

namespace wavecrest {

struct PlaceAndTime {
  double latitude = 35.6894, longitude = 139.6917;  // degrees; Tokyo
  double timezone = 9;                              // hours
  int year = 2010, month = 7, day = 10;
  double hour = 15, minute = 0, second = 0;
};

// Radians; the azimuth clockwise from north.
struct SunPosition {
  double zenithAngle = 0, azimuth = 0;
};

// Blanco-Muriel, Alarcon-Padilla, Lopez-Moratalla, Lara-Coira, "Computing the Solar Vector", Solar Energy 70 (2001);
// right to half a minute of arc.
SunPosition sunPosition(const PlaceAndTime& at);

}  // namespace wavecrest
