#include "library/option_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "bench/whole_number.h"
#include "library/errors.h"
#include "library/suggestion.h"

namespace wavecrest {

namespace {

// False for NaN.
template <class Number>
bool contains(const OptionRange<Number>& range, Number number) {
  return number >= range.least && number <= range.most;
}

// value: the number, or the word that is none.
template <class Number, class Value>
UsageError outOfRange(const std::string& option, const Value& value, const OptionRange<Number>& range,
                      std::string_view also) {
  return UsageError(
      fmt::format("{} {}: expected a number from {} to {}{}", option, value, range.least, range.most, also));
}

}  // namespace

template <class Number>
Number parseNumber(const std::string& option, const std::string& word, const OptionRange<Number>& range) {
  const std::optional<Number> number = wholeNumber<Number>(word);
  if (!number || !contains(range, *number)) throw outOfRange(option, word, range, "");
  return *number;
}
template double parseNumber(const std::string&, const std::string&, const OptionRange<double>&);
template uint64_t parseNumber(const std::string&, const std::string&, const OptionRange<uint64_t>&);

template <class Number>
void requireInRange(const std::string& option, std::type_identity_t<Number> number, const OptionRange<Number>& range,
                    std::string_view also) {
  if (!contains(range, number)) throw outOfRange(option, number, range, also);
}
template void requireInRange(const std::string&, double, const OptionRange<double>&, std::string_view);
template void requireInRange(const std::string&, uint64_t, const OptionRange<uint64_t>&, std::string_view);
template void requireInRange(const std::string&, int, const OptionRange<int>&, std::string_view);

std::optional<double> parseRadius(const std::string& option, const std::string& word) {
  if (word == "auto") return std::nullopt;
  return parseNumber(option, word, kRadiusRange);
}

double parseDuration(const std::string& option, const std::string& text) {
  const auto fail = [&]() -> double {
    throw UsageError(fmt::format("{} '{}': no duration; expected one like 6s, 100ms, 2m or 1h30m", option, text));
  };
  // A sum of numbers with units. The last number may lack its unit and is then in seconds.
  double total = 0;
  const char* at = text.data();
  const char* const end = at + text.size();
  if (at == end) return fail();
  while (at != end) {
    double number = 0;
    const auto [next, error] = std::from_chars(at, end, number);
    if (error != std::errc() || next == at || std::signbit(number)) return fail();
    at = next;
    // A scale of 0 marks an unknown unit.
    const char unit = at == end ? 's' : *at++;
    const bool milli = unit == 'm' && at != end && *at == 's';
    if (milli) ++at;
    const double scale = milli ? 1e-3 : unit == 'h' ? 3600 : unit == 'm' ? 60 : unit == 's' ? 1 : 0;
    total += number * scale;
    if (scale == 0) return fail();
  }
  return std::isfinite(total) && total > 0 ? total : fail();
}

double parseSnapshotInterval(const std::string& option, const std::string& text) {
  constexpr double kLeast = 1e-4;
  const double seconds = parseDuration(option, text);
  if (seconds >= kLeast) return seconds;
  throw UsageError(fmt::format("{} {}: expected log, or 0.1ms or more", option, text));
}

SnapshotSchedule parseSnapshotSchedule(const std::string& option, const std::string& text) {
  if (text.empty()) return SnapshotSchedule::none();
  return text == "log" ? SnapshotSchedule::logarithmic() : SnapshotSchedule::every(parseSnapshotInterval(option, text));
}

std::vector<std::string_view> isaNames() {
  std::vector<std::string_view> names{"auto"};
  for (const Isa isa : kAllIsas) names.push_back(toString(isa));
  return names;
}

Isa parseIsaOption(const std::string& word) {
  if (word == "auto") return bestIsa();
  const Isa isa = kAllIsas[parseChoice("--isa", word, isaNames()) - 1];
  // A known instruction set may be missing in this machine or this build.
  const auto& available = availableIsas();
  if (std::find(available.begin(), available.end(), isa) == available.end()) {
    throw UsageError(fmt::format("--isa {}: this machine or build does not have it", word));
  }
  return isa;
}

std::optional<std::array<uint32_t, 2>> parsePair(std::string_view text, char between) {
  std::array<uint32_t, 2> pair{};
  const char* const end = text.data() + text.size();
  const auto [middle, firstError] = std::from_chars(text.data(), end, pair[0]);
  if (firstError != std::errc() || middle == end || *middle != between) return std::nullopt;
  const auto [rest, secondError] = std::from_chars(middle + 1, end, pair[1]);
  if (secondError != std::errc() || rest != end) return std::nullopt;
  return pair;
}

std::array<uint32_t, 2> parsePart(const std::string& option, const std::string& text) {
  if (const auto part = parsePair(text, '/')) {
    const auto [index, count] = *part;
    if (index >= 1 && index <= count && count <= kMostShares) return *part;
  }
  throw UsageError(
      fmt::format("{} '{}': no part; expected I/N with I from 1 to N, and N up to {}", option, text, kMostShares));
}

std::array<uint32_t, 2> parseSize(const std::string& option, const std::string& text) {
  const auto valid = [](uint32_t n) { return n >= 1 && n <= 65535; };
  if (const auto size = parsePair(text, 'x')) {
    if (std::ranges::all_of(*size, valid)) return *size;
  }
  throw UsageError(fmt::format("{} '{}': no size; expected WIDTHxHEIGHT, each 1 to 65535", option, text));
}

uint64_t parseMemory(const std::string& option, const std::string& text) {
  const auto fail = [&]() -> uint64_t {
    throw UsageError(fmt::format("{} '{}': no memory size; expected one like 800M, 1.5G or 512MiB", option, text));
  };
  double number = 0;
  const char* const end = text.data() + text.size();
  // A number and a unit are required.
  const auto [next, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || next == text.data() || next == end) return fail();
  const std::string_view unit(next, static_cast<size_t>(end - next));
  // The unit is K, M, G or T, then nothing, "B" or "iB". With an i it is a power of 1024, else of 1000.
  const bool binary = unit.size() > 1 && unit[1] == 'i';
  const std::string_view rest = unit.substr(1);
  if (!rest.empty() && rest != "B" && rest != "iB") return fail();
  const size_t power = std::string_view("KMGT").find(unit[0]);
  if (power == std::string_view::npos) return fail();
  // From 1 MB to 1 PB. NaN fails too.
  const double bytes = number * std::pow(binary ? 1024.0 : 1000.0, static_cast<double>(power + 1));
  return bytes >= 1e6 && bytes <= 1e15 ? static_cast<uint64_t>(bytes) : fail();
}

size_t parseChoice(const std::string& option, const std::string& word, std::span<const std::string_view> names) {
  std::vector<std::string> known(names.begin(), names.end());
  for (size_t i = 0; i < names.size(); ++i) {
    if (names[i] == word) return i;
  }
  throw UsageError(fmt::format("{} {}: unknown; expected one of {}{}", option, word, fmt::join(known, ", "),
                               didYouMean(word, known)));
}

// The position of a name is that of its method in kMethods.
Method parseMethodOption(const std::string& option, const std::string& word) {
  std::vector<std::string_view> names;
  names.reserve(std::size(kMethods));
  for (const MethodEntry& entry : kMethods) names.push_back(entry.name);
  return kMethods[parseChoice(option, word, names)].method;
}

std::vector<Method> parseMethodList(std::span<const std::string> words) {
  std::vector<Method> methods;
  for (const std::string& word : words) methods.push_back(parseMethodOption("--methods", word));
  if (!words.empty()) return methods;
  for (const MethodEntry& entry : kMethods) {
    if (!isChosenByTrials(entry.method)) methods.push_back(entry.method);
  }
  return methods;
}

namespace {

// In the order of kAllSamplerKinds.
std::vector<std::string_view> samplerNames() {
  std::vector<std::string_view> names;
  names.reserve(std::size(kAllSamplerKinds) + 1);  // and "auto"
  for (const SamplerKind kind : kAllSamplerKinds) names.push_back(toString(kind));
  return names;
}

}  // namespace

SamplerKind parseSamplerOption(const std::string& option, const std::string& word) {
  const std::vector<std::string_view> names = samplerNames();
  return kAllSamplerKinds[parseChoice(option, word, names)];
}

std::optional<SamplerKind> parseSamplerOrAuto(const std::string& option, const std::string& word) {
  std::vector<std::string_view> names = samplerNames();
  names.insert(names.begin(), "auto");
  const size_t choice = parseChoice(option, word, names);
  return choice > 0 ? std::optional(kAllSamplerKinds[choice - 1]) : std::nullopt;
}

bool mergesPaths(Method method) { return strategiesOf(method).merge; }

std::string methodsWith(bool (*has)(Method)) {
  std::vector<std::string_view> names;
  for (const MethodEntry& entry : kMethods) {
    if (has(entry.method)) names.push_back(entry.name);
  }
  return alternatives(names);
}

}  // namespace wavecrest
