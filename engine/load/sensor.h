// The camera with its film, sampler and reconstruction filter, and what the <integrator> asks for.
#pragma once

#include "engine/load/parameters.h"

namespace wavecrest {

void readSensor(LoadContext& context, const XmlElement& sensor);
void readIntegrator(LoadContext& context, const XmlElement& integrator);

void readPerspective(Parameters&, Sensor&);
void readThinLens(Parameters&, Sensor&);
void readOrthographic(Parameters&, Sensor&);

}  // namespace wavecrest
