#include "bench/score/expected.h"

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <nlohmann/json.hpp>

#include "bench/score/nested_keys.h"
#include "bench/score/score_files.h"
#include "engine/scene/hash_text.h"
#include "kernels/stages.h"

namespace wavecrest {
namespace {

// The end of a key SIZE/GROUP/SCENE/METHOD.
std::string entryKey(const ScoreEntry& entry) { return fmt::format("{}/{}", entry.scene, toString(entry.method)); }

std::string buildKey(ScoreSize size, const std::string& group) {
  return fmt::format("{}/{}", kScoreSizeNames[static_cast<size_t>(size)], group);
}

// The beginning of a key SIZE/GROUP/SCENE/METHOD, with the slash after the group.
std::string groupKey(ScoreSize size, const std::string& group) { return buildKey(size, group) + "/"; }

// Throws ScoreFileError for anything but sixteen hexadecimal digits.
uint64_t parseHash(const std::string& text) {
  uint64_t hash = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), hash, 16);
  if (error != std::errc() || end != text.data() + text.size() || text.size() != 16) {
    throw ScoreFileError(fmt::format("'{}' is no hash; expected sixteen hexadecimal digits", text));
  }
  return hash;
}

}  // namespace

uint64_t hashImage(std::span<const float> samples) {
  // Offset basis and prime of FNV-1a with 64 bits. A step takes the 32 bits of a sample instead of one byte.
  uint64_t hash = 0xcbf29ce484222325u;
  for (const float sample : samples) hash = (hash ^ std::bit_cast<uint32_t>(sample)) * 0x100000001b3u;
  return hash;
}

std::string hashGroup(Isa isa) {
  // A build has all specialised sets of float or none, so one set tells.
  const bool specialized = isCompiled(Precision::floating, Specialization::diffuse);
  return std::string(toString(isa)) + (specialized ? "" : "-general");
}

ImageHashes ImageHashes::parse(const nlohmann::json& file) {
  // Another version of the workload renders other images.
  if (!file.is_object() || file.value("score_version", 0) != kScoreVersion || !file.contains("images")) {
    throw ScoreFileError(fmt::format("has no hashes of score version {}", kScoreVersion));
  }
  ImageHashes all;
  try {
    forEachNested(file.at("images"), 4, [&](const std::string& key, const nlohmann::json& hash) {
      all.hashes_[key] = parseHash(hash.get<std::string>());
    });
    if (!file.contains("builds")) return all;
    forEachNested(file.at("builds"), 2, [&](const std::string& key, const nlohmann::json& build) {
      all.builds_[key] = build.get<std::string>();
    });
  } catch (const nlohmann::json::exception&) {
    throw ScoreFileError("is not made of sizes, instruction sets, scenes, methods and hashes");
  }
  return all;
}

ImageHashes ImageHashes::committed() { return parse(nlohmann::json::parse(kImageHashesJson)); }

nlohmann::ordered_json ImageHashes::toJson() const {
  nlohmann::ordered_json images = nlohmann::ordered_json::object(), builds = images;
  for (const auto& [key, hash] : hashes_) nestedPlace(images, key) = hashText(hash);
  for (const auto& [key, build] : builds_) nestedPlace(builds, key) = build;
  return {{"score_version", kScoreVersion}, {"builds", builds}, {"images", images}};
}

std::optional<uint64_t> ImageHashes::find(ScoreSize size, const std::string& group, const ScoreEntry& entry) const {
  const auto found = hashes_.find(groupKey(size, group) + entryKey(entry));
  return found == hashes_.end() ? std::nullopt : std::optional(found->second);
}

void ImageHashes::set(ScoreSize size, const std::string& group, const ScoreEntry& entry, uint64_t hash) {
  hashes_[groupKey(size, group) + entryKey(entry)] = hash;
}

const std::string& ImageHashes::buildOf(ScoreSize size, const std::string& group) const {
  static const std::string unknown;
  const auto found = builds_.find(buildKey(size, group));
  return found == builds_.end() ? unknown : found->second;
}

void ImageHashes::setBuild(ScoreSize size, const std::string& group, const std::string& build) {
  builds_[buildKey(size, group)] = build;
}

double ReferenceMachine::rateOf(const ScoreEntry& entry) const { return rates.at(entryKey(entry)); }

const ReferenceMachine& referenceMachine() {
  // Parsed once, at the first call.
  static const ReferenceMachine machine = [] {
    const nlohmann::json file = nlohmann::json::parse(kReferenceMachineJson);
    ReferenceMachine reference{.name = file.at("machine"), .rates = {}};
    for (const auto& [scene, methods] : file.at("paths_per_cpu_second").items()) {
      for (const auto& [method, rate] : methods.items()) reference.rates[scene + "/" + method] = rate.get<double>();
    }
    return reference;
  }();
  return machine;
}

}  // namespace wavecrest
