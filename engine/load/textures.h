// Readers of the texture plugins (table in plugins.cpp).
#pragma once

#include "engine/load/parameters.h"

namespace wavecrest {

Texture readBitmapTexture(LoadContext&, Parameters&);
Texture readCheckerboard(LoadContext&, Parameters&);

}  // namespace wavecrest
