#include "engine/load/text_scanner.h"

#include <algorithm>

namespace wavecrest {

bool TextScanner::takeWord(std::string_view word) {
  if (bytesLeft() <= word.size() || std::string_view(at_, word.size()) != word) return false;
  const char next = at_[word.size()];
  if (next != ' ' && next != '\t' && next != '\r' && next != '\n') return false;
  at_ += word.size();
  return true;
}

std::string_view TextScanner::token() const {
  const char* p = at_;
  while (p != end_ && *p != ' ' && *p != '\n' && *p != '\t' && *p != '\r') ++p;
  return {at_, static_cast<size_t>(p - at_)};
}

void TextScanner::skipToken(const char* what) {
  skipSpace();
  if (at_ == end_) fail(std::string("file ends early; expected ") + what);
  at_ += token().size();
}

float TextScanner::readSlowFloat(const char* what) {
  std::string_view text = token();
  at_ += text.size();
  if (text.size() > 1 && text[0] == '+') text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc::invalid_argument || end != text.data() + text.size()) {
    at_ -= 1;  // inside the token, so that the line counted is the token's
    fail("bad number " + inQuotes(text) + "; expected " + what);
  }
  // Out of range of double is out of range of float as well: too small becomes 0, too large is caught as not finite.
  if (error == std::errc::result_out_of_range) {
    const bool tiny = text.find("e-") != std::string_view::npos || text.find("E-") != std::string_view::npos;
    value = tiny ? 0 : HUGE_VAL;
  }
  const float rounded = std::abs(value) > 3.4028235677973366e38 ? HUGE_VALF : static_cast<float>(value);
  if (!std::isfinite(rounded)) {
    at_ -= 1;
    fail("number " + inQuotes(text) + " is not a finite float; expected " + what);
  }
  return rounded;
}

SourceLocation TextScanner::location() const {
  // At the end of the text the last line with content is meant, not the empty one after it.
  const char* position = at_;
  while (at_ == end_ && position != begin_ && static_cast<unsigned char>(position[-1]) <= ' ') --position;
  const auto newlines = std::count(begin_, position, '\n');
  return {std::string(file_), firstLine_ + static_cast<int>(newlines)};
}

}  // namespace wavecrest
