#include "metrics/image/srgb.h"

#include <algorithm>
#include <cmath>

namespace wavecrest {

double srgbDecode(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }

double srgbEncode(double v) { return v <= 0.0031308 ? v * 12.92 : 1.055 * std::pow(v, 1 / 2.4) - 0.055; }

const std::array<double, 256>& srgbDecodeTable() {
  static const auto table = [] {
    std::array<double, 256> t{};
    for (int c = 0; c < 256; ++c) t[static_cast<size_t>(c)] = srgbDecode(c / 255.0);
    return t;
  }();
  return table;
}

namespace {

// Thresholds between neighbouring codes, and for each of kCells equal cells of 0..1 the code at the cell's lower end:
// a look-up and a short walk replace the search. The steepest part of the curve passes 14 codes in one cell.
constexpr size_t kCells = 4096;

struct CodeTables {
  std::array<float, 256> lowerBound;  // smallest value of each code
  std::array<uint8_t, kCells + 1> codeOfCell;
};

const CodeTables& codeTables() {
  static const auto tables = [] {
    CodeTables t{};
    t.lowerBound[0] = 0;
    for (int c = 1; c < 256; ++c) {
      // The smallest float whose exact code is c: start at the rounded threshold and step up to the first that holds.
      double threshold = srgbDecode((c - 0.5) / 255.0);
      auto bound = static_cast<float>(threshold);
      if (bound < threshold) bound = std::nextafter(bound, 2.0f);
      t.lowerBound[static_cast<size_t>(c)] = bound;
    }
    for (size_t cell = 0; cell <= kCells; ++cell) {
      // The last code whose lower bound is not above the cell's lower end.
      float value = static_cast<float>(cell) / kCells;
      auto next = std::upper_bound(t.lowerBound.begin(), t.lowerBound.end(), value);
      t.codeOfCell[cell] = static_cast<uint8_t>(next - t.lowerBound.begin() - 1);
    }
    return t;
  }();
  return tables;
}

// The code of one linear value; values outside 0..1 are clamped.
uint8_t lookUp(const CodeTables& tables, float linear) {
  if (!(linear > 0)) return 0;  // also NaN
  if (linear >= 1) return 255;
  // The cell's lower end has this code or a lower one, so the walk goes upwards.
  size_t code = tables.codeOfCell[static_cast<size_t>(linear * kCells)];
  while (code < 255 && tables.lowerBound[code + 1] <= linear) ++code;
  return static_cast<uint8_t>(code);
}

}  // namespace

uint8_t srgbCode(float linear) { return lookUp(codeTables(), linear); }

Image8 encodeSrgb8(const Image& linear, double exposure) {
  const CodeTables& tables = codeTables();
  const auto scale = static_cast<float>(std::exp2(exposure));
  Image8 out{linear.width, linear.height, std::vector<uint8_t>(linear.pixelCount() * 3)};
  for (size_t i = 0; i < out.pixels.size(); ++i) {
    float value = linear.channels == 1 ? linear.pixels[i / 3] : linear.pixels[i];
    out.pixels[i] = lookUp(tables, value * scale);
  }
  return out;
}

}  // namespace wavecrest
