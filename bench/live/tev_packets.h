// Packets of the image viewer tev (github.com/Tom94/tev, its header Ipc.h): what a renderer sends to show an image.
//
// A packet is its length in bytes, itself included, as a 32-bit number, a byte that tells its kind, and its fields.
// Numbers are little-endian, texts end with a zero, lists of channels are preceded by their count.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "metrics/image/image.h"

namespace wavecrest::tev {

using Packet = std::vector<char>;

// Shows the image of a file that tev can read.
Packet openImage(const std::string& file);
// A new image of that name with channels R, G and B, black; it becomes the one that is shown.
Packet createImage(const std::string& name, uint32_t width, uint32_t height);
// Rows [first, first + count) of a created image, of all that `image` holds.
Packet updateRows(const std::string& name, const Image& image, uint32_t first, uint32_t count);
Packet closeImage(const std::string& name);

}  // namespace wavecrest::tev
