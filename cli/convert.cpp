// wavecrest convert: a scene as wavecrest reads it, in plain Mitsuba 3 XML.
#include <fmt/core.h>

#include <memory>

#include "cli/commands.h"
#include "cli/file_check.h"
#include "cli/messages.h"
#include "cli/scene_options.h"
#include "engine/save/save.h"
#include "library/option_values.h"
#include "scenes/scene_list.h"

namespace wavecrest {
namespace {

namespace fs = std::filesystem;

// The scene is loaded with all that the file says (keepAll), also features that change no image.
struct ConvertOptions {
  SceneOptions scene{.keepAll = true};
  std::string output, progress = "auto";
  bool quiet = false;
};

// Throws UsageError where the folder for meshes and bitmaps exists as a file. Files in an existing folder are replaced.
void checkFolder(const SavePlan& plan) {
  std::error_code ignored;
  if (plan.files.size() > 1 && fs::exists(plan.folder, ignored) && !fs::is_directory(plan.folder, ignored)) {
    throw UsageError(fmt::format("-o: {} is no folder; expected one for meshes and bitmaps, or nothing of that name",
                                 plan.folder.string()));
  }
}

int runConvert(const ConvertOptions& options) {
  // Checks names before the scene is loaded.
  const fs::path output = options.output;
  if (output.extension() != ".xml") {
    throw UsageError(fmt::format("-o {}: expected a name that ends in .xml", options.output));
  }
  const ProgressKind kind =
      quietIf(options.quiet, static_cast<ProgressKind>(parseChoice("--progress", options.progress, kProgressNames)));
  FileCheck files;
  files.input("the scene", findScene(options.scene.scene));
  files.output("-o", output);

  const Scene scene = loadScene(options.scene, kind);
  printNotes(scene, kind);
  // Plans all files of the output, and checks that none is a file of the scene.
  const SavePlan plan = planSave(scene, output);
  for (const std::string& input : scene.files) files.input("the scene", input);
  for (const SavedFile& file : plan.files) {
    if (file.path != output) files.laterOutput("-o", file.path);
  }
  checkFolder(plan);
  // Writes the files.
  saveScene(plan);
  printNotes(plan.notes, kind);
  // One of the files is the XML itself.
  const size_t assets = plan.files.size() - 1;
  printOut("{}: {} shapes, {} materials, {} lights{}\n", options.output, scene.shapes.size(), scene.materials.size(),
           scene.emitters.size(), assets == 0 ? "" : fmt::format("; {} files in {}", assets, plan.folder.string()));
  return kExitDone;
}

}  // namespace

void addConvertCommand(CommandLine& program, int& exitCode) {
  auto options = std::make_shared<ConvertOptions>();
  const Command command = program.add("convert", "write a scene as wavecrest reads it, in plain Mitsuba 3 XML");
  addSceneOptions(command, options->scene);
  command
      .add("-o,--output", options->output,
           "FILE.xml; meshes (PLY) and bitmaps (PNG, EXR) go into the folder FILE-files beside it")
      .required();
  command.add("--progress", options->progress, "auto, bar, jsonl or none: how notes are told").showDefault();
  command.addFlag("--quiet", options->quiet, "tell no notes");
  command.run([options, &exitCode] { exitCode = runConvert(*options); });
}

}  // namespace wavecrest
