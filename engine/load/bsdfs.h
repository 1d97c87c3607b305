// Readers of the BSDF plugins (table in plugins.cpp).
#pragma once

#include "engine/load/parameters.h"

namespace wavecrest {

void readDiffuse(LoadContext&, Parameters&, Material&);
void readConductor(LoadContext&, Parameters&, Material&);
void readRoughConductor(LoadContext&, Parameters&, Material&);
void readDielectric(LoadContext&, Parameters&, Material&);
void readThinDielectric(LoadContext&, Parameters&, Material&);
void readRoughDielectric(LoadContext&, Parameters&, Material&);
void readPlastic(LoadContext&, Parameters&, Material&);
void readRoughPlastic(LoadContext&, Parameters&, Material&);
void readPhong(LoadContext&, Parameters&, Material&);
void readRoughDiffuse(LoadContext&, Parameters&, Material&);  // of Mitsuba 0.6, not supported: names the nearest
void readWard(LoadContext&, Parameters&, Material&);          // likewise
// In principled_bsdfs.cpp.
void readPrincipled(LoadContext&, Parameters&, Material&);
void readPrincipledThin(LoadContext&, Parameters&, Material&);
// Sums of others (blends.cpp).
void readBlend(LoadContext&, Parameters&, Material&);
void readMixture(LoadContext&, Parameters&, Material&);
// Of Mitsuba 0.6, as what is like them (coatings.cpp).
void readCoating(LoadContext&, Parameters&, Material&);
void readRoughCoating(LoadContext&, Parameters&, Material&);
// Adapters around a nested BSDF.
void readTwoSided(LoadContext&, Parameters&, Material&);
void readNull(LoadContext&, Parameters&, Material&);
void readMask(LoadContext&, Parameters&, Material&);
void readBumpMap(LoadContext&, Parameters&, Material&);
void readNormalMap(LoadContext&, Parameters&, Material&);

}  // namespace wavecrest
