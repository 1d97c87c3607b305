// Values that several commands take: durations, sizes, memory, and words of a list. `option` is the name that the
// UsageError of a wrong word begins with.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "engine/session/snapshots.h"
#include "library/option_ranges.h"

namespace wavecrest {

// A number of the range, or UsageError. Number: double or uint64_t.
template <class Number>
Number parseNumber(const std::string& option, const std::string& word, const OptionRange<Number>& range);

// Throws UsageError for a number outside of the range, also for NaN. also: what else is allowed, for the message.
// Number: double, uint64_t or int.
template <class Number>
void requireInRange(const std::string& option, std::type_identity_t<Number> number, const OptionRange<Number>& range,
                    std::string_view also = "");

// "auto" for none, or a number of kRadiusRange; UsageError otherwise.
std::optional<double> parseRadius(const std::string& option, const std::string& word);

// "6s", "100ms", "2m", "1h30m", "0.5s", or plain seconds. Positive and finite, or UsageError.
double parseDuration(const std::string& option, const std::string& text);

// The duration between snapshots, at least 0.1 ms, or UsageError.
double parseSnapshotInterval(const std::string& option, const std::string& text);

// "" for no snapshots, "log" for render times that grow by a fixed ratio, else a duration between snapshots.
SnapshotSchedule parseSnapshotSchedule(const std::string& option, const std::string& text);

// The words that --isa takes: auto, then the names of kAllIsas.
std::vector<std::string_view> isaNames();

// "auto" for the best there is, or the name of one that this machine and build have; UsageError otherwise.
Isa parseIsaOption(const std::string& word);

// Two whole numbers with this character between them, and nothing else; nothing for any other text.
std::optional<std::array<uint32_t, 2>> parsePair(std::string_view text, char between);

// "2/8": which part, from 1 on, of how many; UsageError otherwise.
constexpr uint32_t kMostShares = 100000;
std::array<uint32_t, 2> parsePart(const std::string& option, const std::string& text);

// "1024x768": both 1 to 65535, or UsageError.
std::array<uint32_t, 2> parseSize(const std::string& option, const std::string& text);

// "800M", "1.5G", "512MiB": bytes, by powers of 1000, or of 1024 with an i. At least 1 MB, or UsageError.
uint64_t parseMemory(const std::string& option, const std::string& text);

// The method of that name.
Method parseMethodOption(const std::string& option, const std::string& word);

// The methods of --methods; without words all whose pages are their own, so not evcm, which renders by one of them.
std::vector<Method> parseMethodList(std::span<const std::string> words);

// Whether the method merges paths, so that --radius, --radius-alpha and --light-paths are for it.
bool mergesPaths(Method method);

// The names of all methods that have something, for messages: "ppm, bpm or vcm".
std::string methodsWith(bool (*has)(Method));

// "independent" or "sobol".
SamplerKind parseSamplerOption(const std::string& option, const std::string& word);
// Likewise, or none for "auto".
std::optional<SamplerKind> parseSamplerOrAuto(const std::string& option, const std::string& word);

// The position of a word in a list of names; the UsageError of any other word lists them and suggests the closest.
size_t parseChoice(const std::string& option, const std::string& word, std::span<const std::string_view> names);

}  // namespace wavecrest
