#include "bench/checkpoint/checkpoint.h"

#include <fmt/format.h>
#include <zlib.h>

#include <cstring>

#include "bench/enumerator_name.h"
#include "bench/json_text.h"
#include "engine/scene/hash_text.h"
#include "engine/state/state_stream.h"
#include "engine/version.h"
#include "metrics/image/atomic_file.h"

namespace wavecrest {
namespace {

using Bytes = std::span<const unsigned char>;
using Json = nlohmann::ordered_json;

// kMagic marks checkpoints of all versions, kFormat those of this one.
constexpr std::string_view kMagic = "wavecrest checkpoint ", kFormat = "wavecrest checkpoint 1\n";
constexpr const char* kIntact = "expected one as `render --checkpoint` left it";

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

// More than any render may have.
constexpr uint32_t kMostThreads = 4096;

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
                   {"sampler", std::string(toString(settings.sampler))},
                   {"filter_mode", enumeratorName(kFilterModeNames, statistics.filterMode)},
                   {"precision", enumeratorName(kPrecisionNames, settings.precision)},
                   {"isa", std::string(toString(statistics.isa))},
                   {"accel", enumeratorName(kAccelNames, statistics.accel)},
                   {"specialization", enumeratorName(kSpecializationNames, statistics.specialization)},
                   {"max_depth", limits.maxDepth},
                   {"rr_depth", limits.rouletteDepth}};
  // Settings that matter only for some scenes and methods.
  if (!scene.instances.empty()) identity["instances"] = enumeratorName(kInstancingNames, settings.instancing);
  if (strategiesOf(settings.method).merge) {
    identity.update({{"radius", settings.radius},
                     {"radius_alpha", settings.radiusAlpha},
                     {"light_paths", session.memoryPlan().lightPaths},
                     {"direct_pass", settings.directPass}});
  }
  if (dependsOnWaves(settings.method)) identity["wave"] = settings.waveSize;
  if (hasConnectionRoulette(settings.method)) identity["connection_roulette"] = settings.connectionRoulette;
  if (settings.method == Method::mlt) identity.update(chainIdentity(settings.metropolis));
  return identity;
}

void writeCheckpoint(const std::string& file, const Scene& scene, const RenderSettings& settings,
                     const Session& session, const Json& notes) {
  const Json header = {{"scene", scene.name},
                       {"render", renderIdentity(scene, settings, session)},
                       {"cut", {{"threads", settings.cutForThreads()}}},
                       {"notes", notes}};
  const std::string text = jsonText(header);
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
  session.save(state);
  state.flush();
  out.write(bytesOf(sum));
  out.commit();
}

Checkpoint::Checkpoint(const std::string& file) : file_(file), bytes_(readFileBytes(file)) {
  const Bytes all = bytes_;
  const auto startsWith = [&](std::string_view text) {
    return all.size() >= text.size() && std::memcmp(all.data(), text.data(), text.size()) == 0;
  };
  // The format.
  if (!startsWith(kMagic)) fail("is no checkpoint", kIntact);
  if (!startsWith(kFormat)) fail("is damaged, or a checkpoint of another version", kIntact);
  // Sizes are checked before they are used, then the checksum of everything.
  constexpr size_t kFrame = kFormat.size() + sizeof(uint64_t), kSum = sizeof(uint32_t);
  uint64_t headerBytes = 0;
  uint32_t sum = 0;
  if (all.size() >= kFrame + kSum) {
    std::memcpy(&headerBytes, all.data() + kFormat.size(), sizeof(headerBytes));
    std::memcpy(&sum, all.data() + all.size() - kSum, sizeof(sum));
  }
  if (all.size() < kFrame + kSum || headerBytes > all.size() - kFrame - kSum ||
      sum != checksum(0, all.first(all.size() - kSum))) {
    fail("is damaged or cut short", kIntact);
  }
  // The header. The state stays as bytes until a session is there to take it.
  const Bytes header = all.subspan(kFrame, headerBytes);
  state_ = all.subspan(kFrame + headerBytes, all.size() - kFrame - kSum - headerBytes);
  try {
    const Json parsed = Json::parse(header.begin(), header.end());
    render_ = parsed.at("render");
    notes_ = parsed.at("notes");
    threads_ = parsed.at("cut").at("threads").get<uint32_t>();
    if (!render_.is_object() || threads_ < 1 || threads_ > kMostThreads) fail("has a header that is none", kIntact);
  } catch (const nlohmann::json::exception&) {
    fail("has a header that is none", kIntact);
  }
}

void Checkpoint::fail(const std::string& wrong, const std::string& expected) const {
  throw CheckpointError(fmt::format("{}: {}; {}", file_, wrong, expected));
}

void Checkpoint::cutAlike(RenderSettings& settings) const {
  if (dependsOnWaves(settings.method)) settings.piecesForThreads = threads_;
}

// Throws with the first difference in the order of renderIdentity: the method before its settings, the size before the
// hash.
void Checkpoint::requireSame(const Json& wanted) const {
  for (const auto& [key, value] : wanted.items()) {
    const auto found = render_.find(key);
    if (found != render_.end() && *found == value) continue;
    fail(fmt::format("its {} is {}, not {}", key, found == render_.end() ? "unknown" : wordOf(*found), wordOf(value)),
         "expected the scene and settings that it was made with, or another file");
  }
}

void Checkpoint::restore(const Scene& scene, const RenderSettings& settings, Session& session) const {
  requireSame(renderIdentity(scene, settings, session));
  try {
    StateReader in(state_);
    session.restore(in);
  } catch (const StateError& error) {
    fail(error.what(), kIntact);
  }
}

}  // namespace wavecrest
