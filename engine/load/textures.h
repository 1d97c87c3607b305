// Readers of the texture plugins (table in plugins.cpp).
#pragma once

#include "engine/load/parameters.h"

namespace wavecrest {

Texture readCheckerboard(LoadContext&, Parameters&);

}  // namespace wavecrest
