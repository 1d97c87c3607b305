#include "cli/option_values.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "cli/commands.h"
#include "cli/suggestion.h"

namespace wavecrest {

double parseDuration(const std::string& text) {
  const auto fail = [&]() -> double {
    throw UsageError(fmt::format("'{}' is no duration; expected one like 6s, 2m or 1h30m", text));
  };
  double total = 0;
  const char* at = text.data();
  const char* const end = at + text.size();
  if (at == end) return fail();
  while (at != end) {
    double number = 0;
    const auto [next, error] = std::from_chars(at, end, number);
    if (error != std::errc() || next == at) return fail();
    at = next;
    const char unit = at == end ? 's' : *at++;
    const double scale = unit == 'h' ? 3600 : unit == 'm' ? 60 : unit == 's' ? 1 : 0;
    total += number * scale;
    if (scale == 0) return fail();
  }
  return std::isfinite(total) && total > 0 ? total : fail();
}

SnapshotSchedule parseSnapshotSchedule(const std::string& text) {
  if (text.empty()) return SnapshotSchedule::none();
  return text == "log" ? SnapshotSchedule::logarithmic() : SnapshotSchedule::every(parseDuration(text));
}

Isa parseIsaOption(const std::string& word) {
  if (word == "auto") return bestIsa();
  const std::optional<Isa> isa = parseIsa(word);
  if (!isa) throw UsageError(fmt::format("--isa {}: expected auto, scalar, sse4, avx2 or avx512", word));
  const auto& available = availableIsas();
  if (std::find(available.begin(), available.end(), *isa) == available.end()) {
    throw UsageError(fmt::format("--isa {}: this machine or build does not have it", word));
  }
  return *isa;
}

std::array<uint32_t, 2> parseSize(const std::string& text) {
  std::array<uint32_t, 2> size{};
  const char* const end = text.data() + text.size();
  const auto [x, widthError] = std::from_chars(text.data(), end, size[0]);
  if (widthError == std::errc() && x != end && *x == 'x') {
    const auto [rest, heightError] = std::from_chars(x + 1, end, size[1]);
    const auto valid = [](uint32_t n) { return n >= 1 && n <= 65535; };
    if (heightError == std::errc() && rest == end && valid(size[0]) && valid(size[1])) return size;
  }
  throw UsageError(fmt::format("'{}' is no size; expected WIDTHxHEIGHT, each 1 to 65535", text));
}

uint64_t parseMemory(const std::string& text) {
  const auto fail = [&]() -> uint64_t {
    throw UsageError(fmt::format("'{}' is no memory size; expected one like 800M, 1.5G or 512MiB", text));
  };
  double number = 0;
  const char* const end = text.data() + text.size();
  const auto [next, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || next == text.data() || next == end) return fail();
  const std::string_view unit(next, static_cast<size_t>(end - next));
  const bool binary = unit.size() > 1 && unit[1] == 'i';
  const std::string_view rest = unit.substr(1);
  if (!rest.empty() && rest != "B" && rest != "iB") return fail();
  const size_t power = std::string_view("KMGT").find(unit[0]);
  if (power == std::string_view::npos) return fail();
  const double bytes = number * std::pow(binary ? 1024.0 : 1000.0, static_cast<double>(power + 1));
  return bytes >= 1e6 && bytes <= 1e15 ? static_cast<uint64_t>(bytes) : fail();
}

size_t parseChoice(const std::string& option, const std::string& word, const std::string_view* names, size_t count) {
  std::string choices;
  std::vector<std::string> known;
  for (size_t i = 0; i < count; ++i) {
    if (names[i] == word) return i;
    choices += (i == 0 ? "" : ", ") + std::string(names[i]);
    known.emplace_back(names[i]);
  }
  throw UsageError(fmt::format("{} {}: unknown; expected one of {}{}", option, word, choices, didYouMean(word, known)));
}

Method parseMethodOption(const std::string& option, const std::string& word) {
  std::vector<std::string> known;
  for (const MethodEntry& entry : kMethods) {
    if (entry.name == word) return entry.method;
    known.emplace_back(entry.name);
  }
  throw UsageError(
      fmt::format("{} {}: unknown; expected one of {}{}", option, word, methodChoices(), didYouMean(word, known)));
}

}  // namespace wavecrest
