#include "bench/checkpoint/holdings.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "engine/plan/share_iterations.h"

namespace wavecrest {
namespace {

using Json = nlohmann::ordered_json;

// Iterations of a run in words. Users count parts from 1, iterations from 0.
std::string describe(const Holdings::Run& run) {
  if (run.end - run.begin == 1) return fmt::format("{}", run.begin);
  return fmt::format("{} to {}", run.begin, run.end - 1);
}

// As many as a line has room for.
std::string joined(const std::vector<std::string>& words) {
  constexpr size_t kMost = 12;
  if (words.size() <= kMost) return fmt::format("{}", fmt::join(words, ", "));
  return fmt::format("{} and {} more", fmt::join(words.begin(), words.begin() + kMost, ", "), words.size() - kMost);
}

std::string partName(uint64_t part, uint64_t parts) { return fmt::format("{}/{}", part + 1, parts); }

// What is not in the runs of [0, end).
std::vector<Holdings::Run> gapsOf(const std::vector<Holdings::Run>& runs, uint64_t end) {
  std::vector<Holdings::Run> gaps;
  uint64_t next = 0;
  for (const Holdings::Run& run : runs) {
    if (run.begin > next) gaps.push_back({next, run.begin});
    next = run.end;
  }
  if (next < end) gaps.push_back({next, end});
  return gaps;
}

// The parts that begin, end or lie within gaps.
std::vector<std::string> partsIn(const std::vector<Holdings::Run>& gaps, uint64_t of, uint32_t parts) {
  std::vector<std::string> names;
  for (uint32_t part = 0; part < parts; ++part) {
    const uint64_t begin = beginOfShare(of, part, parts), end = beginOfShare(of, part + 1, parts);
    const auto meets = [&](const Holdings::Run& gap) { return gap.begin < end && begin < gap.end; };
    if (std::any_of(gaps.begin(), gaps.end(), meets)) names.push_back(partName(part, parts));
  }
  return names;
}

std::string missingIterations(const Holdings& holdings) {
  const std::vector<Holdings::Run> gaps = gapsOf(holdings.runs, holdings.of);
  if (gaps.empty()) return {};
  std::vector<std::string> words;
  words.reserve(gaps.size());
  for (const Holdings::Run& gap : gaps) words.push_back(describe(gap));
  std::string text = fmt::format("iterations {}", joined(words));
  if (holdings.of == 0) return text;
  text += fmt::format(" of {}", holdings.of);
  const std::vector<std::string> parts = partsIn(gaps, holdings.of, holdings.parts);
  if (holdings.parts == 1 || parts.empty()) return text;
  return text + fmt::format(" ({} {})", parts.size() == 1 ? "part" : "parts", joined(parts));
}

std::string missingChains(const Holdings& holdings, uint64_t allChains) {
  std::vector<std::string> words;
  // Shares that nobody has, as numbers modulo the largest number of parts.
  uint32_t parts = holdings.parts;
  for (const Holdings::ChainShare& share : holdings.chains) parts = std::max(parts, share.parts);
  std::vector<char> missing(parts);
  for (uint64_t chain = 0; chain < allChains; ++chain) {
    const auto has = [&](const Holdings::ChainShare& share) { return chain % share.parts == share.part; };
    if (std::none_of(holdings.chains.begin(), holdings.chains.end(), has)) missing[chain % parts] = 1;
  }
  for (uint32_t part = 0; part < parts; ++part) {
    if (missing[part]) words.push_back(fmt::format("the chains of part {}", partName(part, parts)));
  }
  // Shares that have not come to the end.
  for (const Holdings::ChainShare& share : holdings.chains) {
    if (share.iterations >= holdings.of) continue;
    const uint64_t lacking = holdings.of - share.iterations;
    words.push_back(
        fmt::format("{} of {} iterations of part {}", lacking, holdings.of, partName(share.part, share.parts)));
  }
  return joined(words);
}

}  // namespace

std::string Holdings::overlap(const Holdings& other) const {
  for (const Run& mine : runs) {
    for (const Run& theirs : other.runs) {
      const Run both{std::max(mine.begin, theirs.begin), std::min(mine.end, theirs.end)};
      if (both.begin < both.end) return "iterations " + describe(both);
    }
  }
  for (const ChainShare& mine : chains) {
    for (const ChainShare& theirs : other.chains) {
      // Some number leaves both remainders exactly if they agree modulo what both numbers of parts share.
      const uint32_t common = std::gcd(mine.parts, theirs.parts);
      if (mine.part % common != theirs.part % common) continue;
      const ChainShare& smaller = mine.parts > theirs.parts ? mine : theirs;
      return "chains of part " + partName(smaller.part, smaller.parts);
    }
  }
  return {};
}

void Holdings::add(const Holdings& other) {
  // A part of none has nothing to join.
  runs.insert(runs.end(), other.runs.begin(), other.runs.end());
  std::sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) { return a.begin < b.begin; });
  std::vector<Run> joined;
  for (const Run& run : runs) {
    if (!joined.empty() && joined.back().end == run.begin) {
      joined.back().end = run.end;
    } else {
      joined.push_back(run);
    }
  }
  runs = std::move(joined);
  chains.insert(chains.end(), other.chains.begin(), other.chains.end());
  lacking += other.lacking;
  of = std::max(of, other.of);
  parts = std::max(parts, other.parts);
  sum = true;
}

std::string Holdings::missing(uint64_t allChains) const {
  std::string text = chains.empty() ? missingIterations(*this) : missingChains(*this, allChains);
  if (lacking == 0) return text;
  return text + fmt::format("{}{} samples of pixels, where a render stopped within an iteration",
                            text.empty() ? "" : "; ", lacking);
}

Holdings holdingsOf(const RenderSettings& settings, const Session& session) {
  Holdings holdings;
  holdings.of = settings.share.iterations.value_or(settings.iterations.value_or(0));
  // Shares of rounds have no parts of the image that could be named.
  holdings.parts = settings.share.rounds ? 1 : settings.share.parts;
  if (settings.method == Method::mlt) {
    holdings.chains = {{settings.share.part, settings.share.parts, session.statistics().iterations}};
    return holdings;
  }
  // The last run goes on to the end of the iteration that was begun.
  const Film& film = session.film();
  const uint64_t most = film.maxSamples();
  for (const auto& [begin, end] : ShareIterations(settings).runs(most)) holdings.runs.push_back({begin, end});
  holdings.lacking = most * film.area().pixels.size() - film.allSamples();
  return holdings;
}

Json toJson(const Holdings& holdings) {
  Json runs = Json::array(), chains = Json::array();
  for (const Holdings::Run& run : holdings.runs) runs.push_back({run.begin, run.end});
  for (const Holdings::ChainShare& share : holdings.chains) {
    chains.push_back({share.part, share.parts, share.iterations});
  }
  return {{"iterations", runs}, {"chains", chains},        {"lacking", holdings.lacking},
          {"of", holdings.of},  {"parts", holdings.parts}, {"sum", holdings.sum}};
}

Holdings holdingsFrom(const Json& json) {
  Holdings holdings;
  for (const Json& run : json.at("iterations")) {
    holdings.runs.push_back({run.at(0).get<uint64_t>(), run.at(1).get<uint64_t>()});
  }
  for (const Json& share : json.at("chains")) {
    holdings.chains.push_back(
        {share.at(0).get<uint32_t>(), std::max(share.at(1).get<uint32_t>(), 1u), share.at(2).get<uint64_t>()});
  }
  holdings.lacking = json.at("lacking").get<uint64_t>();
  holdings.of = json.at("of").get<uint64_t>();
  holdings.parts = std::max(json.at("parts").get<uint32_t>(), 1u);
  holdings.sum = json.at("sum").get<bool>();
  return holdings;
}

}  // namespace wavecrest
