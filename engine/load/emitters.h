// Lights: <emitter> elements to scene.emitters, and the readers of the emitter plugins (table in plugins.cpp).
#pragma once

#include "engine/load/plugins.h"

namespace wavecrest {

// Adds an <emitter> of the scene itself, after all shapes. An `area` light belongs to the shapes that refer to it, and
// is refused if none does.
void addEmitter(LoadContext& context, const XmlElement& emitter);

// The <emitter type="area"> of a shape.
AreaEmitter readAreaEmitter(LoadContext& context, const XmlElement& emitter, uint32_t shape);

EmitterKind readPoint(LoadContext&, Parameters&);
EmitterKind readSpot(LoadContext&, Parameters&);
EmitterKind readDirectional(LoadContext&, Parameters&);
EmitterKind readConstant(LoadContext&, Parameters&);
EmitterKind readEnvmap(LoadContext&, Parameters&);

}  // namespace wavecrest
