// What error estimates of Metropolis light transport are worth.
#pragma once

#include <cstddef>

namespace wavecrest {

// Of so many independent renders an estimate says what it says of other methods.
constexpr size_t kFewestChainRenders = 16;

// Said wherever an error of mlt comes from fewer (engine/chains/README.md).
constexpr const char* kChainsMislead =
    "errors of mlt from few renders are too small: in dim regions most renders are too dark and a few far too bright";

}  // namespace wavecrest
