#include "bench/campaign/scene_reference.h"

#include <fmt/format.h>

#include <chrono>
#include <thread>

#include "bench/campaign/file_lock.h"
#include "engine/inspect/path_classes.h"
#include "engine/scene/hash_text.h"
#include "metrics/image/atomic_file.h"

namespace wavecrest {
namespace {

namespace fs = std::filesystem;

// Why an image cannot be the reference of this scene; empty if it can.
std::string misfit(const Reference& reference, const Scene& scene, const CampaignSettings& settings) {
  if (std::string wrong = whyNoReference(reference); !wrong.empty()) return wrong;
  if (reference.mean.width != settings.size[0] || reference.mean.height != settings.size[1]) {
    return fmt::format("is {}x{} pixels; expected {}x{}", reference.mean.width, reference.mean.height, settings.size[0],
                       settings.size[1]);
  }
  const std::string hash = hashText(scene.hash);
  if (reference.info.sceneHash != hash) {
    return fmt::format("is of scene_hash {}; expected {} of this {}", reference.info.sceneHash, hash, scene.name);
  }
  return "";
}

// The reference in the reference folder. wrong: why it cannot be used; then `reference` is empty.
struct GivenReference {
  fs::path file;
  std::optional<Reference> reference;
  std::string wrong;
};

// A word of a command line, quoted where a shell would not take it as it is.
std::string shellWord(const std::string& word) {
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./=,+:@%";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char letter : word) quoted += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
  return quoted + "'";
}

// The command that renders the reference of a scene into the reference folder.
std::string referenceCommand(const CampaignScene& entry, const CampaignSettings& settings, const fs::path& file) {
  std::string command = fs::is_directory(settings.referenceFolder)
                            ? ""
                            : fmt::format("mkdir -p {} && ", shellWord(settings.referenceFolder.string()));
  command +=
      fmt::format("wavecrest reference {} --size {}x{}", shellWord(entry.word), settings.size[0], settings.size[1]);
  for (const auto& [name, value] : settings.definitions) command += " -D " + shellWord(name + "=" + value);
  return command + " -o " + shellWord(file.string());
}

// Looks for the reference in the reference folder. Throws ReferenceError where it cannot be used and none may be
// rendered.
GivenReference givenReference(const Scene& scene, const CampaignScene& entry, const CampaignSettings& settings) {
  GivenReference given{.file = settings.referenceFolder / (entry.name + ".exr"), .reference = {}, .wrong = {}};
  const bool exists = fs::is_regular_file(given.file);
  if (exists) {
    given.reference = readReference(given.file);
    given.wrong = misfit(*given.reference, scene, settings);
    if (given.wrong.empty()) return given;
    given.reference.reset();
  } else {
    given.wrong = "does not exist";
  }
  if (settings.referenceRequired) {
    throw ReferenceError(
        fmt::format("{}: {}; {} by `{}`", given.file.string(), given.wrong,
                    exists ? "move it away and make another" : "expected the reference of " + entry.name + "; make it",
                    referenceCommand(entry, settings, given.file)));
  }
  // Shards that render references by time would get different images. By iterations all get the same one.
  if (settings.shard.count > 1 && !settings.iterations) {
    throw ReferenceError(
        fmt::format("{}: {}; expected --reference with a folder of references, or every shard would "
                    "render another",
                    given.file.string(), given.wrong));
  }
  return given;
}

// Renders the reference, or goes on with it, by the method that suits the path classes. Its effort is a multiple of
// that of a run.
Reference renderOwn(const Scene& scene, const CampaignScene& entry, const CampaignSettings& settings,
                    const fs::path& file, const ReferenceHooks& hooks) {
  const ReferenceChoice choice = classifyPaths(scene).reference;
  RenderSettings render = settings.render;
  render.method = choice.method;
  render.seed = 0;
  render.limits = pathLimits(scene.defaults.maxDepth, scene.defaults.rrDepth);
  render.radius = kReferenceRadius;
  render.roulette = Roulette::efficiency;
  render.radiusAlpha = RenderSettings().radiusAlpha;
  render.mergeVertices = RenderSettings().mergeVertices;
  render.lightPaths.reset();  // as many as pixels, whatever the runs have
  ReferenceGoal goal;
  if (settings.iterations) {
    goal.iterations = static_cast<uint64_t>(kReferenceEffort) * *settings.iterations;
  } else {
    goal.seconds = kReferenceEffort * entry.effort.seconds;
  }
  Reference made = renderReference(scene, render, choice.reason, goal, file, hooks);
  // The file keeps fewer bits of the halves' difference. Other processes measure against the file, so this process
  // reads it too.
  return fs::is_regular_file(file) ? readReference(file) : made;
}

}  // namespace

bool referenceExists(const Scene& scene, const CampaignScene& entry, const CampaignSettings& settings) {
  return givenReference(scene, entry, settings).reference.has_value();
}

fs::path referenceFile(const std::string& scene) { return fs::path("references") / (scene + ".exr"); }

Reference sceneReference(const Scene& scene, const CampaignScene& entry, const CampaignSettings& settings,
                         const ReferenceHooks& hooks, const std::function<void(const std::string&)>& say) {
  const fs::path file = settings.out / referenceFile(entry.name);
  const GivenReference given = givenReference(scene, entry, settings);
  if (given.reference) {
    // A copy of the file keeps every bit and all attributes.
    writeFileAtomically(file.string(), readFileBytes(given.file.string()));
    return *given.reference;
  }
  say(fmt::format("{}: rendering its reference ({} {})", entry.name, given.file.string(), given.wrong));
  for (bool waits = false;; waits = true) {
    try {
      return renderOwn(scene, entry, settings, file, hooks);
    } catch (const FileIsLocked&) {
      if (settings.shard.count == 1) throw;
    }
    // Another shard renders the same one.
    if (!waits) say(fmt::format("{}: waiting for another shard to render its reference", entry.name));
    if (hooks.stopped && hooks.stopped()) return {};
    std::this_thread::sleep_for(std::chrono::seconds(1));
  }
}

}  // namespace wavecrest
