// The film of a session as an image, for metrics and files.
#pragma once

#include "engine/session/session.h"
#include "metrics/image/image.h"

namespace wavecrest {

inline Image filmImage(const Session& session) {
  const FilmArea& area = session.film().area();
  return {.width = area.width, .height = area.height, .channels = 3, .pixels = session.film().resolve()};
}

}  // namespace wavecrest
