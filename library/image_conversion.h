// Between the images of the interface and those of the metrics.
#pragma once

#include <string>

#include "metrics/image/image.h"
#include "wavecrest/image.h"

namespace wavecrest {

// Throws ImageError where the number of samples does not follow from width and height.
void checkPixels(const std::string& name, const api::Image& image);

Image toImage(api::Image image);

}  // namespace wavecrest
