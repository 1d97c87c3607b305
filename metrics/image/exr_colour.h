// What the channels of an OpenEXR layer mean, and how they become linear Rec. 709 (files have primaries of their own).
#pragma once

#include <ImathBox.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>

#include <string>
#include <vector>

#include "metrics/image/codecs.h"

namespace wavecrest::codecs {

// The colour of a layer. lumaChroma: luminance Y, and RY = (R - Y) / Y and BY = (B - Y) / Y, which may be subsampled.
enum class ExrColour { rgb, xyz, lumaChroma, luminance };

// The channels of a layer by which it is read, in the order R G B, X Y Z, Y RY BY, or Y. Without names it is not there.
struct ExrChannels {
  ExrColour colour = ExrColour::rgb;
  std::vector<std::string> names;
};
ExrChannels findExrChannels(const Imf::ChannelList& channels, const std::string& layer);

// Where the samples of one channel of a file are read to. A subsampled channel has a buffer of its own, and is spread
// over its column of the image afterwards, linearly between its samples.
class ExrChannelTarget {
 public:
  ExrChannelTarget(const Imf::Channel& channel, Image& image, size_t column);
  // For a FrameBuffer. window: the data window of the file, whose size the image has.
  Imf::Slice slice(const Imath::Box2i& window);
  void spread() const;

 private:
  bool isSubsampled() const { return stepX_ > 1 || stepY_ > 1; }
  float at(uint32_t x, uint32_t y) const { return samples_[size_t{y} * width_ + x]; }

  Image& image_;
  size_t column_;
  uint32_t stepX_, stepY_, width_ = 0, height_ = 0;
  std::vector<float> samples_;
};

// Converts pixels as stored to linear Rec. 709: by the primaries and the white point that the header gives, without
// adaptation to another white, as Mitsuba does. Luminance alone is returned in the first of three channels.
void convertExrColour(const std::string& path, const Imf::Header& header, ExrColour colour, Image& image);

// OpenEXR allocates what an attribute of the header announces. Throws ImageError where that is more than the file has.
void checkExrHeader(const std::string& path, Bytes bytes);

}  // namespace wavecrest::codecs
