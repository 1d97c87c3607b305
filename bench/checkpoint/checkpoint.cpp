#include "bench/checkpoint/checkpoint.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>

#include "bench/enumerator_name.h"
#include "bench/json_text.h"
#include "engine/scene/hash_text.h"
#include "engine/state/state_stream.h"
#include "engine/version.h"
#include "metrics/image/atomic_file.h"
#include "metrics/image/image.h"

namespace wavecrest {
namespace {

using Bytes = std::span<const unsigned char>;
using Json = nlohmann::ordered_json;

// kMagic marks checkpoints of all versions, kFormat those of this one.
constexpr std::string_view kMagic = "wavecrest checkpoint ", kFormat = "wavecrest checkpoint 2\n";
// What stands before the header and after the state.
constexpr size_t kFrame = kFormat.size() + sizeof(uint64_t), kSum = sizeof(uint32_t);

Bytes bytesOf(std::string_view text) { return {reinterpret_cast<const unsigned char*>(text.data()), text.size()}; }

template <class T>
Bytes bytesOf(const T& number) {
  static_assert(std::is_arithmetic_v<T>);
  return {reinterpret_cast<const unsigned char*>(&number), sizeof(number)};
}

// CRC-32 of all bytes so far and these. before: the sum so far, 0 at first.
uint32_t checksum(uint32_t before, Bytes bytes) {
  return bytes.empty() ? before : static_cast<uint32_t>(crc32_z(before, bytes.data(), bytes.size()));
}

// The settings of Markov chains that decide the image.
Json chainIdentity(const MetropolisSettings& chains) {
  return {{"mlt", enumeratorName(kMetropolisVariantNames, chains.variant)},
          {"chains", chains.chains},
          {"bootstrap", chains.bootstrapSamples},
          {"restart", chains.restartSteps.value_or(0)},
          {"large_step", chains.largeStep},
          {"path_mutations", chains.pathMutations},
          {"direct_pass", chains.directPass}};
}

// Which of several processes renders its share at the same time as others theirs; 1/1: no others.
std::string processOf(const RenderSettings& settings) {
  if (!settings.share.rounds) return "1/1";
  std::string name = fmt::format("{}/{}", settings.share.part + 1, settings.share.parts);
  // The last round of iterations is cut into shares by where the image ends.
  if (!settings.share.iterations || settings.method == Method::mlt) return name;
  return fmt::format("{} of {} iterations", name, *settings.share.iterations);
}

// More than any render may have.
constexpr uint32_t kMostThreads = 4096;

bool startsWith(Bytes bytes, std::string_view text) {
  return bytes.size() >= text.size() && std::memcmp(bytes.data(), text.data(), text.size()) == 0;
}

// The bytes of the header, from the file's first kFrame bytes. Throws where it is of no format or longer than the file.
uint64_t headerBytes(const std::string& file, Bytes frame, uint64_t fileBytes) {
  if (!startsWith(frame, kMagic)) failCheckpoint(file, "is no checkpoint", kIntactCheckpoint);
  if (!startsWith(frame, kFormat)) {
    failCheckpoint(file, "is damaged, or a checkpoint of another version", kIntactCheckpoint);
  }
  uint64_t bytes = 0;
  if (frame.size() >= kFrame) std::memcpy(&bytes, frame.data() + kFormat.size(), sizeof(bytes));
  if (fileBytes < kFrame + kSum || bytes > fileBytes - kFrame - kSum) {
    failCheckpoint(file, "is damaged or cut short", kIntactCheckpoint);
  }
  return bytes;
}

CheckpointHeader parseHeader(const std::string& file, Bytes text) {
  try {
    const Json parsed = Json::parse(text.begin(), text.end());
    const auto threads = parsed.at("cut").at("threads").get<uint32_t>();
    if (!parsed.at("render").is_object() || !parsed.at("notes").is_object() || threads < 1 || threads > kMostThreads) {
      failCheckpoint(file, "has a header that is none", kIntactCheckpoint);
    }
    return {.scene = parsed.at("scene").get<std::string>(),
            .render = parsed.at("render"),
            .cut = parsed.at("cut"),
            .notes = parsed.at("notes"),
            .holds = holdingsFrom(parsed.at("holds"))};
  } catch (const nlohmann::json::exception&) {
    failCheckpoint(file, "has a header that is none", kIntactCheckpoint);
  }
}

// A value for messages, strings without their quotes.
std::string wordOf(const Json& value) { return value.is_string() ? value.get<std::string>() : value.dump(); }

}  // namespace

Json renderIdentity(const Scene& scene, const RenderSettings& settings, const Session& session) {
  const RenderStatistics statistics = session.statistics();
  const FilmArea& film = session.film().area();
  const PathLimits limits = withinDepthOfMethod(settings).limits;
  // Settings of every method, as the session uses them.
  Json identity = {{"version", kVersion},
                   {"commit", kCommit},
                   {"method", std::string(toString(settings.method))},
                   {"size", fmt::format("{}x{}", film.width, film.height)},
                   {"scene_hash", hashText(scene.hash)},
                   {"seed", settings.seed},
                   {"first_iteration", settings.firstIteration},
                   {"process", processOf(settings)},
                   {"sampler", std::string(toString(statistics.sampler))},
                   {"filter_mode", enumeratorName(kFilterModeNames, statistics.filterMode)},
                   {"precision", enumeratorName(kPrecisionNames, settings.precision)},
                   {"isa", std::string(toString(statistics.isa))},
                   {"accel", enumeratorName(kAccelNames, statistics.accel)},
                   {"specialization", enumeratorName(kSpecializationNames, statistics.specialization)},
                   {"max_depth", limits.maxDepth},
                   {"rr_depth", limits.rouletteDepth}};
  // Settings that matter only for some scenes and methods.
  if (!scene.instances.empty()) identity["instances"] = enumeratorName(kInstancingNames, settings.instancing);
  const Method method = statistics.renderedBy(settings.method);
  if (statistics.choice) identity["chosen"] = std::string(toString(method));
  if (strategiesOf(method).merge) {
    identity.update({{"radius", statistics.mergeRadius->first},
                     {"radius_alpha", settings.radiusAlpha},
                     {"light_paths", session.memoryPlan().lightPaths},
                     {"direct_pass", settings.directPass}});
  }
  if (hasRouletteChoice(method)) identity["roulette"] = enumeratorName(kRouletteNames, settings.roulette);
  if (method == Method::lt) identity["light_paths"] = session.memoryPlan().lightPaths;
  if (choosesMergeVertices(method)) {
    identity["merge_vertices"] = enumeratorName(kMergeVerticesNames, settings.mergeVertices);
  }
  if (dependsOnWaves(method)) identity["wave"] = settings.waveSize;
  if (hasConnectionRoulette(method)) identity["connection_roulette"] = settings.connectionRoulette;
  if (settings.method == Method::gpt) {
    identity["guide"] = enumeratorName(kGuideTargetNames, settings.guide);
    identity["guide_memory"] = settings.guideBytes;
  }
  if (settings.method == Method::mlt) {
    identity.update(chainIdentity(settings.metropolis));
    identity["part"] = fmt::format("{}/{}", settings.share.part + 1, settings.share.parts);
  }
  return identity;
}

void writeCheckpoint(const std::string& file, const Scene& scene, const RenderSettings& settings,
                     const Session& session, const Json& notes) {
  writeCheckpoint(file,
                  {.scene = scene.name,
                   .render = renderIdentity(scene, settings, session),
                   .cut = {{"threads", settings.cutForThreads()}},
                   .notes = notes,
                   .holds = holdingsOf(settings, session)},
                  [&](StateWriter& out) { session.save(out); });
}

void writeCheckpoint(const std::string& file, const CheckpointHeader& header,
                     const std::function<void(StateWriter&)>& save) {
  const std::string text = jsonText(Json{{"scene", header.scene},
                                         {"render", header.render},
                                         {"holds", toJson(header.holds)},
                                         {"cut", header.cut},
                                         {"notes", header.notes}});
  AtomicFile out(file);
  uint32_t sum = 0;
  // The checksum covers every byte that is written before it.
  const auto write = [&](Bytes bytes) {
    sum = checksum(sum, bytes);
    out.write(bytes);
  };
  // Format, header, state and checksum.
  write(bytesOf(kFormat));
  write(bytesOf(uint64_t{text.size()}));
  write(bytesOf(std::string_view(text)));
  StateWriter state(write);
  save(state);
  state.flush();
  out.write(bytesOf(sum));
  out.commit();
}

CheckpointHeader readCheckpointHeader(const std::string& file) {
  FileReader in(file);
  const std::vector<unsigned char> frame = in.read(kFrame);
  return parseHeader(file, in.read(headerBytes(file, frame, in.size())));
}

Checkpoint::Checkpoint(const std::string& file) : file_(file), bytes_(readFileBytes(file)) {
  const Bytes all = bytes_;
  // Sizes are checked before they are used, then the checksum of everything.
  const uint64_t header = headerBytes(file, all.first(std::min(all.size(), kFrame)), all.size());
  uint32_t sum = 0;
  std::memcpy(&sum, all.data() + all.size() - kSum, sizeof(sum));
  if (sum != checksum(0, all.first(all.size() - kSum))) {
    failCheckpoint(file_, "is damaged or cut short", kIntactCheckpoint);
  }
  // The state stays as bytes until somebody is there to take it.
  header_ = parseHeader(file_, all.subspan(kFrame, header));
  state_ = all.subspan(kFrame + header, all.size() - kFrame - kSum - header);
}

void failCheckpoint(const std::string& file, const std::string& wrong, const std::string& expected) {
  throw CheckpointError(fmt::format("{}: {}; {}", file, wrong, expected));
}

void Checkpoint::cutAlike(RenderSettings& settings) const {
  if (dependsOnWaves(settings.method)) settings.piecesForThreads = header_.cut.at("threads").get<uint32_t>();
  // On fewer threads than before, a budget of memory has room for more light paths.
  const auto lightPaths = header_.render.find("light_paths");
  if (settings.memoryBytes && lightPaths != header_.render.end()) settings.mostLightPaths = lightPaths->get<uint64_t>();
}

void requireSameRender(const std::string& file, const Json& found, const Json& wanted,
                       std::span<const std::string_view> except, const std::string& expected) {
  for (const auto& [key, value] : wanted.items()) {
    if (std::find(except.begin(), except.end(), key) != except.end()) continue;
    const auto own = found.find(key);
    if (own != found.end() && *own == value) continue;
    failCheckpoint(
        file, fmt::format("its {} is {}, not {}", key, own == found.end() ? "unknown" : wordOf(*own), wordOf(value)),
        expected);
  }
}

void Checkpoint::restore(const Scene& scene, const RenderSettings& settings, Session& session) const {
  const bool forgot = header_.holds.sum && session.statistics().guide;
  if (!header_.holds.goesOn() || forgot) {
    failCheckpoint(
        file_, "is a sum of parts that no render goes on from",
        "expected a checkpoint of `render`, or a sum of iterations without gaps; not of mlt, nor with a guide");
  }
  requireSameRender(file_, header_.render, renderIdentity(scene, settings, session));
  try {
    StateReader in(state_);
    session.restore(in);
  } catch (const StateError& error) {
    failCheckpoint(file_, error.what(), kIntactCheckpoint);
  }
}

}  // namespace wavecrest
