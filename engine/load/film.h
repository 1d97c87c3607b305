// Film, reconstruction filter and sampler of a sensor.
#pragma once

#include "engine/load/parameters.h"

namespace wavecrest {

// Null: the sensor has none, and Mitsuba's defaults hold (hdrfilm of 768 x 576, gaussian filter; 4 samples).
void readFilm(LoadContext& context, const XmlElement* film);
void readSampler(LoadContext& context, const XmlElement* sampler);

void readBoxFilter(Parameters&, FilmSettings&);
void readTentFilter(Parameters&, FilmSettings&);
void readGaussianFilter(Parameters&, FilmSettings&);

}  // namespace wavecrest
