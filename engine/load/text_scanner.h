// Reads numbers from a large text in memory: the inner loop of ASCII PLY and OBJ files.
//
// In: a buffer that ends with a newline (ScannableText). Out: numbers; LoadError with the line when there is none. The
// line is only counted when an error is reported, so keeping it costs nothing.
#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include "engine/load/load.h"
#include "engine/load/values.h"

namespace wavecrest {

class TextScanner {
 public:
  // `text` must end with '\n': every loop below stops there without looking at the end of the buffer.
  TextScanner(std::string_view text, std::string_view file, int firstLine = 1)
      : begin_(text.data()), at_(text.data()), end_(text.data() + text.size()), file_(file), firstLine_(firstLine) {}

  bool atEnd() const { return at_ == end_; }
  void skipBlanks() {
    while (*at_ == ' ' || *at_ == '\t' || *at_ == '\r') ++at_;
  }
  void skipSpace() {
    while (at_ != end_ && (*at_ == ' ' || *at_ == '\n' || *at_ == '\t' || *at_ == '\r')) ++at_;
  }
  bool atLineEnd() {
    skipBlanks();
    return *at_ == '\n';
  }
  void skipLine() {
    while (*at_ != '\n') ++at_;
    ++at_;
  }
  char peek() const { return *at_; }
  void advance(size_t count) { at_ += count; }
  // Whether the text goes on with `word` followed by a blank or the line's end.
  bool takeWord(std::string_view word);

  float readFloat(const char* what);
  int64_t readInteger(const char* what);
  // Skips one token, number or not. what: names it in the error at the end of the file.
  void skipToken(const char* what);
  size_t bytesLeft() const { return static_cast<size_t>(end_ - at_); }

  SourceLocation location() const;
  [[noreturn]] void fail(const std::string& message) const { throw LoadError(location(), message); }

 private:
  std::string_view token() const;
  float readSlowFloat(const char* what);

  const char *begin_, *at_, *end_;
  std::string_view file_;
  int firstLine_;
};

inline bool isDigit(char c) { return static_cast<unsigned char>(c - '0') < 10; }

// Decimal to float in one pass: up to 19 digits are gathered in an integer and scaled by an exactly representable power
// of ten (Clinger, "How to Read Floating Point Numbers Accurately", PLDI 1990, fast path); anything else goes to
// std::from_chars.
inline float TextScanner::readFloat(const char* what) {
  static constexpr double kPowers[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                       1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
  skipSpace();
  if (at_ == end_) fail(std::string("file ends early; expected ") + what);
  const char* p = at_;
  const bool negative = *p == '-';
  if (*p == '-' || *p == '+') ++p;
  uint64_t digits = 0;
  const char* first = p;
  while (isDigit(*p)) digits = digits * 10 + static_cast<uint64_t>(*p++ - '0');
  ptrdiff_t count = p - first, exponent = 0;
  if (*p == '.') {
    const char* fraction = ++p;
    while (isDigit(*p)) digits = digits * 10 + static_cast<uint64_t>(*p++ - '0');
    exponent = fraction - p;
    count -= exponent;
  }
  if (count == 0 || count > 19) return readSlowFloat(what);
  if (*p == 'e' || *p == 'E') {
    const char* q = p + 1;
    const bool negativeExponent = *q == '-';
    if (*q == '-' || *q == '+') ++q;
    ptrdiff_t value = 0;
    const char* firstDigit = q;
    while (isDigit(*q) && q - firstDigit < 4) value = value * 10 + (*q++ - '0');
    if (q == firstDigit || isDigit(*q)) return readSlowFloat(what);
    exponent += negativeExponent ? -value : value;
    p = q;
  }
  const bool exact = digits <= (uint64_t{1} << 53) && exponent >= -22 && exponent <= 22;
  if (!exact || !(*p == ' ' || *p == '\n' || *p == '\r' || *p == '\t')) return readSlowFloat(what);
  at_ = p;
  const double magnitude =
      exponent < 0 ? static_cast<double>(digits) / kPowers[-exponent] : static_cast<double>(digits) * kPowers[exponent];
  return static_cast<float>(negative ? -magnitude : magnitude);
}

inline int64_t TextScanner::readInteger(const char* what) {
  skipSpace();
  if (at_ == end_) fail(std::string("file ends early; expected ") + what);
  const char* p = at_;
  const bool negative = *p == '-';
  if (*p == '-' || *p == '+') ++p;
  const char* first = p;
  int64_t value = 0;
  while (isDigit(*p) && p - first < 18) value = value * 10 + (*p++ - '0');
  if (p == first || isDigit(*p)) fail("bad integer " + inQuotes(token()) + "; expected " + what);
  at_ = p;
  return negative ? -value : value;
}

}  // namespace wavecrest
