#include "library/campaign_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "library/errors.h"
#include "library/option_values.h"

namespace wavecrest {
namespace {

// The words of an option; null where it was not given.
const std::vector<std::string>* given(const CampaignWords& words, const char* name) {
  const auto found = words.find(name);
  return found == words.end() || found->second.empty() ? nullptr : &found->second;
}

// The row of each name that --methods takes: a plain one of each method, then those of other choices.
std::vector<CampaignMethod> allRows() {
  std::vector<CampaignMethod> rows;
  rows.reserve(2 * kMethods.size() + 2);
  for (const MethodEntry& entry : kMethods) rows.push_back({.method = entry.method});
  rows.push_back({.method = Method::mlt, .variant = MetropolisVariant::pathspace});
  rows.push_back({.method = Method::mlt, .variant = MetropolisVariant::pssmlt});
  rows.push_back({.method = Method::ppm, .directPass = true});
  for (const MethodEntry& entry : kMethods) {
    if (entry.method != Method::mlt) rows.push_back({.method = entry.method, .automatic = true});
  }
  return rows;
}

// The rows that one word of --methods names: usually one. "mlt" means the variants of --mlt where that is given, and
// with
// --direct-pass "ppm" means "ppm-direct" as well.
std::vector<CampaignMethod> rowsOfWord(const std::string& word, const CampaignWords& words) {
  const CampaignMethod row = allRows()[parseChoice("--methods", word, campaignMethodNames())];
  std::vector<CampaignMethod> rows{row};
  const auto* variants = given(words, "--mlt");
  if (row == CampaignMethod{.method = Method::mlt} && variants != nullptr) {
    rows.clear();
    for (const std::string& name : *variants) {
      const size_t variant = parseChoice("--mlt", name, kMetropolisVariantNames);
      rows.push_back({.method = Method::mlt, .variant = static_cast<MetropolisVariant>(variant)});
    }
  }
  if (row == CampaignMethod{.method = Method::ppm} && given(words, "--direct-pass") != nullptr) {
    rows.push_back({.method = Method::ppm, .directPass = true});
  }
  return rows;
}

// The rows of a campaign without --methods: those of the profile, or one of each method.
std::vector<std::string> defaultMethods(const Profile& profile) {
  std::vector<std::string> names;
  for (const CampaignMethod& row : profile.rows) names.push_back(row.name());
  if (!names.empty()) return names;
  for (const MethodEntry& entry : kMethods) names.emplace_back(entry.name);
  return names;
}

// All rows of the campaign in the order of the words, each once: two words may stand for the same row.
std::vector<CampaignMethod> chosenMethods(const CampaignWords& words, const Profile& profile) {
  const auto* named = given(words, "--methods");
  std::vector<std::string> names = named != nullptr ? *named : defaultMethods(profile);
  // --mlt takes the place of the profile's choice.
  if (named == nullptr && given(words, "--mlt") != nullptr) {
    std::erase_if(names, [](const std::string& name) { return name.starts_with("mlt-"); });
  }
  std::vector<CampaignMethod> methods;
  for (const std::string& name : names) {
    for (const CampaignMethod& row : rowsOfWord(name, words)) {
      if (std::find(methods.begin(), methods.end(), row) == methods.end()) methods.push_back(row);
    }
  }
  return methods;
}

}  // namespace

std::span<const std::string_view> campaignMethodNames() {
  static const auto texts = [] {
    std::vector<std::string> all;
    for (const CampaignMethod& row : allRows()) all.push_back(row.name());
    return all;
  }();
  static const std::vector<std::string_view> names(texts.begin(), texts.end());
  return names;
}

std::map<std::string, std::string> parseDefinitions(const std::vector<std::string>& words) {
  std::map<std::string, std::string> definitions;
  for (const std::string& word : words) {
    const size_t equals = word.find('=');
    if (equals == std::string::npos || equals == 0) throw UsageError(fmt::format("-D {}: expected NAME=VALUE", word));
    definitions[word.substr(0, equals)] = word.substr(equals + 1);
  }
  return definitions;
}

void chooseRows(const CampaignWords& words, const Profile& profile, CampaignSettings& settings) {
  // Rows, and values of the scenes' variables.
  settings.methods = chosenMethods(words, profile);
  if (const auto* definitions = given(words, "-D")) settings.definitions = parseDefinitions(*definitions);
  // Settings of merging methods, and the clock.
  RenderSettings& render = settings.render;
  render.radius = profile.radius;
  if (const auto* radius = given(words, "--radius")) render.radius = parseRadius("--radius", radius->front());
  render.mergeVertices = profile.mergeVertices;
  render.balancedWalks = profile.balancedWalks;
  render.guide = GuideTarget::automatic;
  if (const auto* vertices = given(words, "--merge-vertices")) {
    render.mergeVertices =
        static_cast<MergeVertices>(parseChoice("--merge-vertices", vertices->front(), kMergeVerticesNames));
  }
  if (const auto* alpha = given(words, "--radius-alpha")) {
    render.radiusAlpha = parseNumber("--radius-alpha", alpha->front(), kRadiusAlphaRange);
  }
  render.roulette = profile.roulette;
  if (const auto* roulette = given(words, "--roulette")) {
    render.roulette = static_cast<Roulette>(parseChoice("--roulette", roulette->front(), kRouletteNames));
  }
  // An option is stronger than the profile's choice.
  if (profile.lightPaths != 0) render.lightPaths = profile.lightPaths;
  if (const auto* paths = given(words, "--light-paths")) {
    render.lightPaths = parseNumber("--light-paths", paths->front(), kLightPathRange);
  }
  if (const auto* clock = given(words, "--clock")) {
    render.clock = static_cast<ClockKind>(parseChoice("--clock", clock->front(), kClockNames));
  }
}

bool takesSampler(const CampaignMethod& row) {
  const bool isPssmlt = row.method == Method::mlt && row.variant == MetropolisVariant::pssmlt;
  return !row.automatic && !isPssmlt;
}

void refuseUnusedWords(const CampaignWords& words, const CampaignSettings& settings) {
  const auto anyRow = [&](const auto& test) {
    return std::any_of(settings.methods.begin(), settings.methods.end(), test);
  };
  // Rows "-auto" have default settings and ignore all of these options.
  const auto anyMethod = [&](bool (*test)(Method)) {
    return anyRow([test](const CampaignMethod& row) { return !row.automatic && test(row.method); });
  };
  // Options of merging methods.
  const std::pair<const char*, bool> merging[] = {
      {"--radius", given(words, "--radius") != nullptr},
      {"--radius-alpha", settings.render.radiusAlpha != RenderSettings().radiusAlpha},
      {"--light-paths", given(words, "--light-paths") != nullptr}};
  const bool merges = anyMethod(mergesPaths);
  for (const auto& [name, chosen] : merging) {
    if (!chosen || merges) continue;
    throw UsageError(fmt::format("{}: no method of the campaign merges; expected {} among --methods", name,
                                 methodsWith(mergesPaths)));
  }
  const bool walks = anyMethod(hasRouletteChoice);
  if (given(words, "--roulette") != nullptr && !walks) {
    throw UsageError(fmt::format("--roulette: no method of the campaign has the choice; expected {} among --methods",
                                 methodsWith(hasRouletteChoice)));
  }
  const bool choosesVertices = anyMethod(choosesMergeVertices);
  if (given(words, "--merge-vertices") != nullptr && !choosesVertices) {
    throw UsageError(
        fmt::format("--merge-vertices: no method of the campaign has the choice; expected {} among --methods",
                    methodsWith(choosesMergeVertices)));
  }
  if (given(words, "--sampler") != nullptr && !anyRow(takesSampler)) {
    throw UsageError(
        "--sampler: is for no row of the campaign; expected one without -auto, other than mlt-pssmlt, among --methods");
  }
  // Options that make rows of ppm and mlt.
  if (given(words, "--direct-pass") != nullptr && !anyRow([](const CampaignMethod& row) { return row.directPass; })) {
    throw UsageError("--direct-pass: is for ppm alone; expected ppm among --methods");
  }
  const auto* const variants = given(words, "--mlt");
  if (variants == nullptr) return;
  for (const std::string& word : *variants) {
    const auto isRow = [&](const CampaignMethod& row) {
      return row.method == Method::mlt && kMetropolisVariantNames[static_cast<size_t>(row.variant)] == word;
    };
    const bool asByDefault = word == kMetropolisVariantNames[static_cast<size_t>(MetropolisSettings().variant)];
    if (asByDefault || anyRow(isRow)) continue;
    throw UsageError(fmt::format("--mlt {}: is no row of the campaign; expected mlt among --methods", word));
  }
}

void addRowKeys(const CampaignSettings& settings, std::map<std::string, std::string>& keys) {
  // Lists as text, for readers of the file.
  std::string methods, definitions;
  for (const CampaignMethod& method : settings.methods) methods += (methods.empty() ? "" : " ") + method.name();
  for (const auto& [name, value] : settings.definitions) {
    definitions += fmt::format("{}{}={}", definitions.empty() ? "" : " ", name, value);
  }
  keys["methods"] = methods;
  keys["clock"] = kClockNames[static_cast<size_t>(settings.render.clock)];
  keys["radius"] = settings.render.radius ? fmt::format("{:g}", *settings.render.radius) : "auto";
  keys["radius_alpha"] = fmt::format("{:g}", settings.render.radiusAlpha);
  keys["roulette"] = kRouletteNames[static_cast<size_t>(settings.render.roulette)];
  keys["merge_vertices"] = kMergeVerticesNames[static_cast<size_t>(settings.render.mergeVertices)];
  keys["light_paths"] = settings.render.lightPaths ? std::to_string(*settings.render.lightPaths) : "one per pixel";
  if (!definitions.empty()) keys["definitions"] = definitions;
}

}  // namespace wavecrest
