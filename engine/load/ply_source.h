// The values of the body of a PLY file, one after the other: two sources with the same functions, for text and binary.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

#include "engine/load/ply_header.h"
#include "engine/load/text_scanner.h"

namespace wavecrest {

// Values of a text body. Each value is a decimal number, whatever type the header gives.
class AsciiSource {
 public:
  explicit AsciiSource(const TextScanner& scanner) : scanner_(scanner) {}

  float real(PlyType) { return scanner_.readFloat(kNumber); }
  int64_t integer(PlyType) { return scanner_.readInteger("a whole number"); }
  // Skipped values need not be finite.
  void skip(PlyType, uint64_t count) {
    for (uint64_t i = 0; i < count; ++i) scanner_.skipToken(kNumber);
  }
  // Whether `count` more values can follow at all: at least a digit and a separator each.
  bool canHold(PlyType, uint64_t count) const { return count <= scanner_.bytesLeft() / 2; }
  bool atEnd() {
    scanner_.skipSpace();
    return scanner_.atEnd();
  }
  [[noreturn]] void fail(const std::string& message) const { scanner_.fail(message); }

 private:
  static constexpr const char* kNumber = "a number of the announced element";

  TextScanner scanner_;
};

template <class T>
T byteSwapped(T value) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof(T));
  std::reverse(bytes, bytes + sizeof(T));
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

// Values of a binary body, in the types that the header gives. Errors are reported at the first line of the body:
// binary data has no lines.
class BinarySource {
 public:
  BinarySource(std::string_view body, bool swap, SourceLocation where)
      : at_(body.data()), end_(body.data() + body.size()), swap_(swap), where_(std::move(where)) {}

  float real(PlyType type) { return static_cast<float>(value(type)); }
  int64_t integer(PlyType type) {
    // All integer types of PLY are exact in double.
    const double number = value(type);
    if (number != std::floor(number) || std::abs(number) > 1e15) fail("index is not whole; expected an integer type");
    return static_cast<int64_t>(number);
  }
  void skip(PlyType type, uint64_t count) {
    if (!canHold(type, count)) fail("file ends early; expected the announced elements");
    at_ += byteSize(type) * count;
  }
  bool canHold(PlyType type, uint64_t count) const { return count <= static_cast<size_t>(end_ - at_) / byteSize(type); }
  bool atEnd() const { return at_ == end_; }
  // The next bytes, if there are so many and they are in the order of this machine; else nullptr. They stay unread.
  const char* peek(uint64_t bytes) const { return swap_ || bytes > static_cast<size_t>(end_ - at_) ? nullptr : at_; }
  [[noreturn]] void fail(const std::string& message) const { throw LoadError(where_, message); }

 private:
  // The next value, which has type T in the file.
  template <class T>
  double read() {
    T value;
    if (static_cast<size_t>(end_ - at_) < sizeof(T)) fail("file ends early; expected the announced elements");
    std::memcpy(&value, at_, sizeof(T));
    at_ += sizeof(T);
    return static_cast<double>(swap_ ? byteSwapped(value) : value);
  }
  // The next value, of a type that the header gives.
  double value(PlyType type) {
    switch (type) {
      case PlyType::int8:
        return read<int8_t>();
      case PlyType::uint8:
        return read<uint8_t>();
      case PlyType::int16:
        return read<int16_t>();
      case PlyType::uint16:
        return read<uint16_t>();
      case PlyType::int32:
        return read<int32_t>();
      case PlyType::uint32:
        return read<uint32_t>();
      case PlyType::float32:
        return read<float>();
      case PlyType::float64:
        return read<double>();
    }
    return 0;
  }

  const char *at_, *end_;
  bool swap_;
  SourceLocation where_;
};

}  // namespace wavecrest
