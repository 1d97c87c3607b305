// States as bytes in memory.
#pragma once

#include <vector>

#include "engine/state/state_stream.h"

namespace wavecrest {

// Of a session, a film, or whatever saves itself.
template <class Saved>
std::vector<unsigned char> savedState(const Saved& saved) {
  return savedBytes([&](StateWriter& out) { saved.save(out); });
}

template <class Restored>
void restoreState(Restored& restored, std::span<const unsigned char> bytes) {
  StateReader in(bytes);
  restored.restore(in);
}

}  // namespace wavecrest
