// How long a render has to be, where its time has ended before it had an image.
#pragma once

#include <string>

namespace wavecrest {

// Seconds rounded up: to two digits below 10, to whole ones from there on.
std::string roundedUpSeconds(double seconds);

// What is expected of the time, "more than 15 s", where it has ended after so many seconds and so many passes over the
// film. once: seconds of it that trials took, which no pass takes again.
std::string longerTime(double seconds, double once, double passes);

}  // namespace wavecrest
