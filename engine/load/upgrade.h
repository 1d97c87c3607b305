// Names of Mitsuba 0.4 to 1.x turned into those of Mitsuba 3, element by element, as Mitsuba 3 itself does on loading.
#pragma once

#include "engine/load/xml_document.h"

namespace wavecrest {

// Tag and attributes: lookAt -> lookat, name="intIOR" -> name="int_ior", a bsdf's type="bump" -> type="bumpmap", and
// colours without `intent`.
void upgradeElement(XmlElement& element);

// What spans several children: uoffset, voffset, uscale, vscale -> one to_uv transform.
void upgradeChildren(XmlElement& element);

}  // namespace wavecrest
