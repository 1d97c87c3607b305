// Readers of the texture plugins (table in plugins.cpp).
#pragma once

#include "engine/load/parameters.h"

namespace wavecrest {

Texture readBitmapTexture(LoadContext&, Parameters&);
Texture readCheckerboard(LoadContext&, Parameters&);
Texture readRawConstant(LoadContext&, Parameters&);
Texture readScaleTexture(LoadContext&, Parameters&);  // of Mitsuba 0.6: a texture times a colour

}  // namespace wavecrest
