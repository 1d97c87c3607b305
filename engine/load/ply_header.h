// The header of a PLY file: which elements with which properties follow, and in which encoding.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/load/load.h"

namespace wavecrest {

enum class PlyFormat { ascii, binaryLittleEndian, binaryBigEndian };
enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

size_t byteSize(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;  // of the value, or of the items of a list
  bool isList = false;
  PlyType countType = PlyType::uint8;
};

struct PlyElement {
  std::string name;
  uint64_t count = 0;
  std::vector<PlyProperty> properties;
  int line = 0;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  size_t bodyOffset = 0;  // of the first byte after the header
  int bodyLine = 0;
};

// `text` is the content of the file and a newline behind it. Checks that the file has one element of vertices and one
// of faces, and is long enough for the counts that the header announces.
PlyHeader readPlyHeader(std::string_view text, std::string_view file);

}  // namespace wavecrest
