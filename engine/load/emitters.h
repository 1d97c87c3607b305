// Lights: <emitter> elements to scene.emitters, and the readers of the emitter plugins (table in plugins.cpp).
#pragma once

#include "engine/load/plugins.h"

namespace wavecrest {

// Adds an <emitter> of the scene itself, after all shapes. An `area` light belongs to the shapes that refer to it, and
// is refused if none does.
void addEmitter(LoadContext& context, const XmlElement& emitter);

// The <emitter type="area"> of a shape.
AreaEmitter readAreaEmitter(LoadContext& context, const XmlElement& emitter, uint32_t shape);

// What the to_world of a light around the scene may be: LoadError if it shears or flattens, a note if it scales
// unevenly.
void checkEnvironmentTransform(LoadContext& context, const Parameters& parameters, const Matrix4& toWorld);

EmitterKind readPoint(LoadContext&, Parameters&);
EmitterKind readSpot(LoadContext&, Parameters&);
EmitterKind readProjector(LoadContext&, Parameters&);
EmitterKind readDirectional(LoadContext&, Parameters&);
EmitterKind readConstant(LoadContext&, Parameters&);
EmitterKind readEnvmap(LoadContext&, Parameters&);
EmitterKind readSunsky(LoadContext&, Parameters&);  // also `sky` and `sun`

// Makes one light of the first and second, if one is the sun and the other the sky of the same day: `sun` and `sky` of
// Mitsuba 0.6 beside each other.
bool joinSunAndSky(EmitterKind& first, const EmitterKind& second);

}  // namespace wavecrest
