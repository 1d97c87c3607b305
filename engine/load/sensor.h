// The camera with its film, sampler and reconstruction filter.
#pragma once

#include "engine/load/parameters.h"

namespace wavecrest {

void readSensor(LoadContext& context, const XmlElement& sensor);

void readPerspective(Parameters&, Sensor&);
void readThinLens(Parameters&, Sensor&);
void readOrthographic(Parameters&, Sensor&);

}  // namespace wavecrest
