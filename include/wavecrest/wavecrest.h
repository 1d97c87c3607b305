// libwavecrest: load scenes, render them by any of the methods, compare images, run campaigns and read their results.
//
// The library is the program: `wavecrest render` and its kin do what these functions do, with the same options, words,
// defaults and numbers. Facts that the program writes as JSON (stats, inspection) are JSON here, too.
//
// Objects own what they show; nothing needs to be initialised. Whatever fails throws Error.
#pragma once

#include "wavecrest/campaign.h"
#include "wavecrest/compare.h"
#include "wavecrest/error.h"
#include "wavecrest/image.h"
#include "wavecrest/render.h"
#include "wavecrest/scene.h"

namespace wavecrest::api {

WAVECREST_EXPORT const char* version();  // "0.1.0"
WAVECREST_EXPORT const char* commit();   // that the library was built from

}  // namespace wavecrest::api
