// A look at a render under way: its image and its numbers at one moment, for those who show them.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "bench/until/film_error.h"
#include "metrics/image/image.h"

namespace wavecrest {

struct Look {
  Image image;
  uint64_t iterations = 0;  // of the pixel that has fewest
  uint64_t paths = 0;
  double renderSeconds = 0;
  std::optional<FilmError> error;  // as last estimated, for errorIterations iterations
  uint64_t errorIterations = 0;
  bool last = false;  // the render is over
};

// Takes a look without keeping the render waiting; called while it pauses.
using LookTaker = std::function<void(std::shared_ptr<const Look>)>;

}  // namespace wavecrest
