#include "bench/live/tev_packets.h"

#include <bit>
#include <cassert>
#include <concepts>
#include <cstring>

namespace wavecrest::tev {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they are");

// The packet kinds of tev that are sent. updateImage is its UpdateImageV3, with offsets and strides, and openImage its
// OpenImageV2, with a separate choice of channels.
enum class Kind : uint8_t { closeImage = 2, createImage = 4, updateImage = 6, openImage = 7 };

constexpr const char* kChannels[] = {"R", "G", "B"};
constexpr size_t kChannelCount = std::size(kChannels);

// Builds a packet field by field. Its first field is the length, which is filled in at the end.
class Writer {
 public:
  explicit Writer(Kind kind, size_t room = 256) {
    packet_.reserve(room);
    number(uint32_t{0});
    number(static_cast<uint8_t>(kind));
  }
  template <std::integral T>
  Writer& number(T value) {
    bytes(&value, sizeof value);
    return *this;
  }
  Writer& flag(bool value) { return number(static_cast<uint8_t>(value)); }
  // A text with a zero byte at its end.
  Writer& text(const std::string& value) {
    bytes(value.c_str(), value.size() + 1);
    return *this;
  }
  // A position or a size in pixels, which tev takes as a signed number.
  Writer& side(uint32_t value) { return number(static_cast<int32_t>(value)); }
  // The number of channels, then their names.
  Writer& channels() {
    number(static_cast<int32_t>(kChannelCount));
    for (const char* name : kChannels) text(name);
    return *this;
  }
  Writer& floats(std::span<const float> values) {
    bytes(values.data(), values.size_bytes());
    return *this;
  }
  Packet finished() {
    const auto length = static_cast<uint32_t>(packet_.size());
    std::memcpy(packet_.data(), &length, sizeof length);
    return std::move(packet_);
  }

 private:
  void bytes(const void* data, size_t count) {
    const char* const begin = static_cast<const char*>(data);
    packet_.insert(packet_.end(), begin, begin + count);
  }
  Packet packet_;
};

}  // namespace

Packet openImage(const std::string& file) {
  // An empty choice of channels means all. The flag asks tev to show the image at once.
  const std::string allChannels;
  return Writer(Kind::openImage).flag(true).text(file).text(allChannels).finished();
}

Packet createImage(const std::string& name, uint32_t width, uint32_t height) {
  return Writer(Kind::createImage).flag(true).text(name).side(width).side(height).channels().finished();
}

Packet updateRows(const std::string& name, const Image& image, uint32_t first, uint32_t count) {
  assert(image.channels == kChannelCount && first + count <= image.height);
  const size_t row = kChannelCount * image.width;
  Writer writer(Kind::updateImage, 256 + name.size() + count * row * sizeof(float));
  // Without the flag tev goes on showing the image that the user has chosen.
  writer.flag(false).text(name).channels().side(0).side(first).side(image.width).side(count);
  // Where a channel's first float is, and how far its next: channels are interleaved.
  for (size_t channel = 0; channel < kChannelCount; ++channel) writer.number(static_cast<int64_t>(channel));
  for (size_t channel = 0; channel < kChannelCount; ++channel) writer.number(static_cast<int64_t>(kChannelCount));
  return writer.floats(std::span(image.pixels).subspan(first * row, count * row)).finished();
}

Packet closeImage(const std::string& name) { return Writer(Kind::closeImage).text(name).finished(); }

}  // namespace wavecrest::tev
