// Reads <transform> and the x, y, z attributes that its operations share with <point> and <vector>.
//
// The operations apply in the order they are written, so each new one multiplies from the left. Double precision:
// Mitsuba composes in double too and rounds to float at the end.
#pragma once

#include <initializer_list>
#include <string_view>

#include "engine/load/context.h"
#include "engine/load/matrix.h"
#include "engine/load/xml_document.h"

namespace wavecrest {

Matrix4 readTransform(LoadContext& context, const XmlElement& transform);
// Attributes x, y, z (absent: fallback) or value="s" / "x, y, z".
Double3 readVectorAttributes(const XmlElement& element, double fallback);
// Throws unless every attribute of the element is in `known`.
void checkAttributes(const XmlElement& element, std::initializer_list<std::string_view> known);

}  // namespace wavecrest
