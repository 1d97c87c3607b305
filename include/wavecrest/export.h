// What libwavecrest.so exports; everything else in it is hidden.
#pragma once

#define WAVECREST_EXPORT __attribute__((visibility("default")))
