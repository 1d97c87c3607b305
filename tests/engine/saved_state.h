// States as bytes in memory.
#pragma once

#include <vector>

#include "engine/state/state_stream.h"

namespace wavecrest {

// Of a session, a film, or whatever saves itself.
template <class Saved>
std::vector<unsigned char> savedState(const Saved& saved) {
  std::vector<unsigned char> bytes;
  StateWriter out([&](std::span<const unsigned char> block) { bytes.insert(bytes.end(), block.begin(), block.end()); });
  saved.save(out);
  out.flush();
  return bytes;
}

template <class Restored>
void restoreState(Restored& restored, std::span<const unsigned char> bytes) {
  StateReader in(bytes);
  restored.restore(in);
}

}  // namespace wavecrest
