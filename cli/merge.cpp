// wavecrest merge: the image of a render whose parts were rendered one by one, on any machines.
#include <fmt/core.h>

#include <memory>

#include "bench/campaign/merged_reference.h"
#include "bench/campaign/render_stats.h"
#include "bench/checkpoint/merge.h"
#include "bench/json_text.h"
#include "cli/commands.h"
#include "cli/file_check.h"
#include "cli/messages.h"
#include "cli/progress.h"
#include "library/option_values.h"
#include "metrics/image/image_io.h"

namespace wavecrest {
namespace {

struct MergeOptions {
  std::vector<std::string> parts, outputs;
  std::string checkpoint, reference, stats, progress = "auto";
  bool complete = false;
};

// Throws UsageError for outputs that cannot be written, or that would replace a part or each other.
void checkFiles(const MergeOptions& options) {
  FileCheck files;
  for (const std::string& part : options.parts) files.input("a part", part);
  for (const std::string& image : options.outputs) files.image("-o", image);
  if (options.checkpoint == kStandardStream) throw UsageError("--checkpoint -: expected a file");
  if (!options.checkpoint.empty()) files.output("--checkpoint", options.checkpoint);
  if (!options.reference.empty()) files.reference("--reference", options.reference);
  if (!options.stats.empty()) files.output("--stats", options.stats);
}

std::string errorInWords(const MergedParts& merged) {
  if (!merged.relativeError) return "relative error not known";
  return fmt::format("relative error {:.3g}, from how far the parts lie apart", *merged.relativeError);
}

int runMerge(const MergeOptions& options) {
  const auto kind = static_cast<ProgressKind>(parseChoice("--progress", options.progress, kProgressNames));
  checkFiles(options);
  const MergedParts merged = mergeParts(options.parts, !options.reference.empty());
  const nlohmann::ordered_json& stats = merged.header.notes.at("stats");
  // What is missing is said before anything is written.
  if (!merged.missing.empty()) {
    if (options.complete) {
      tell("wavecrest: error: --complete: missing are {}; expected all parts", merged.missing);
      return kExitCheck;
    }
    warn(kind, "missing are " + merged.missing);
  }
  if (!merged.whyNoHalves.empty()) {
    throw InputError(
        fmt::format("--reference: {}; expected an even number of equal, independent parts", merged.whyNoHalves));
  }
  // Images, reference, checkpoint and statistics.
  if (!options.outputs.empty()) {
    // Chains have made a pass once they have made as many mutations as there are pixels, and their direct pass, whose
    // samples are dealt out to all parts, once each pixel has one.
    const FilmArea& area = merged.film->area();
    const nlohmann::ordered_json& render = merged.header.render;
    const bool chains = !merged.header.holds.chains.empty();
    const bool samples = !chains || (render.value("direct_pass", false) && render.value("mlt", "") != "pssmlt");
    const bool whole =
        (!samples || merged.film->minSamples() != 0) && (!chains || merged.film->splatCount() >= area.size());
    if (!whole) throw InputError("no whole pass over the film: no image was written; expected parts of at least one");
    const Image image{.width = area.width, .height = area.height, .channels = 3, .pixels = merged.film->resolve()};
    for (const std::string& name : options.outputs) {
      WritingProgress progress(kind, name);
      writeImage(name, image, statsMetadata(stats), [&](double fraction) { progress.show(fraction); });
    }
  }
  if (!options.reference.empty()) writeReference(options.reference, mergedReference(merged));
  if (!options.checkpoint.empty()) writeSum(options.checkpoint, merged);
  if (!options.stats.empty()) writeText(options.stats, jsonText(stats, 2) + "\n");
  noteLine(kind,
           {{"outputs", options.outputs},
            {"parts", options.parts.size()},
            {"iterations", stats.at("iterations")},
            {"relative_error", merged.relativeError ? nlohmann::ordered_json(*merged.relativeError) : nullptr},
            {"missing", merged.missing}},
           fmt::format("{}: {} spp of {} parts, {}",
                       options.outputs.empty() ? "no -o, so no image was written" : options.outputs.front(),
                       stats.at("iterations").get<uint64_t>(), options.parts.size(), errorInWords(merged)));
  return kExitDone;
}

}  // namespace

void addMergeCommand(CommandLine& program, int& exitCode) {
  auto options = std::make_shared<MergeOptions>();
  const Command command = program.add("merge", "add up the parts that `render --part` has rendered");
  command.add("PART", options->parts, "checkpoints of parts, or sums of some").required();
  command.add("-o,--output", options->outputs, "image file: .exr, .png or .pfm; repeatable").repeatable();
  command.add("--checkpoint", options->checkpoint, "write the sum as a checkpoint, to be merged with further parts");
  command.add("--reference", options->reference,
              "EXR file: a reference for `converge`, whose halves are every other part and those between");
  command.add("--stats", options->stats, "write statistics as JSON; - for stdout");
  command.addFlag("--complete", options->complete, "write nothing and end with 4 where anything is missing");
  command.add("--progress", options->progress, "auto, bar, jsonl or none").showDefault();
  command.run([options, &exitCode] { exitCode = runMerge(*options); });
}

}  // namespace wavecrest
