// wavecrest inspect: what a scene asks of the program, and what each method can do in it.
#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "bench/json_text.h"
#include "cli/commands.h"
#include "cli/inspect_guide.h"
#include "cli/messages.h"
#include "cli/scene_options.h"
#include "engine/inspect/inspection.h"
#include "engine/scene/scene_error.h"
#include "engine/tasks/processors.h"
#include "library/inspection_json.h"
#include "library/option_ranges.h"
#include "library/option_values.h"

namespace wavecrest {
namespace {

// The options as written on the command line.
struct InspectOptions {
  SceneOptions scene;
  std::string precision = "float", accel = "auto", instances = "auto";
  uint32_t threads = 0, wave = RenderSettings{}.waveSize;
  GuideOptions guide;
  bool json = false;
};

// Names as the options and the JSON spell them.
std::string name(Specialization specialization) {
  return std::string(kSpecializationNames[static_cast<size_t>(specialization)]);
}
std::string name(Accel accel) { return std::string(kAccelNames[static_cast<size_t>(accel)]); }
std::string name(Verdict verdict) { return std::string(kVerdictNames[static_cast<size_t>(verdict)]); }

// ---- text -----------------------------------------------------------------------------------------------------------

// "1 dielectric, 2 diffuse"; "none" for an empty map.
std::string listed(const std::map<std::string, size_t>& counts) {
  std::string text;
  for (const auto& [kind, count] : counts) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, kind);
  return text.empty() ? "none" : text;
}

// Decimal megabytes (10^6 bytes) without the unit.
std::string megabytes(size_t bytes) { return fmt::format("{:.2f}", static_cast<double>(bytes) / 1e6); }

// One line for each kind of fact about the scene, then what kernels and intersector it gets.
void printFacts(const Scene& scene, const SceneInspection& facts) {
  const BoundingSphere& bounds = facts.bounds;
  std::string needs;
  for (const std::string& need : facts.needs) needs += (needs.empty() ? "" : "; ") + need;
  printOut("{}\n\n", scene.name);
  printOut("BSDFs       {}\nlights      {}\ntextures    {}\n", listed(facts.bsdfs), listed(facts.lights),
           listed(facts.textures));
  printOut("sensor      {}, {} x {}, {} filter\n", facts.sensor, scene.film.imageWidth(), scene.film.imageHeight(),
           facts.filter);
  printOut("primitives  {} quads, {} triangles, {} spheres\n", facts.primitives.quads, facts.primitives.triangles,
           facts.primitives.spheres);
  if (facts.instances != 0) {
    printOut("instances   {} of {} shape groups, {}\n", facts.instances, facts.groups,
             facts.keepsInstances ? "in a hierarchy of two levels" : "as copies");
  }
  printOut("bounds      ({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g}), radius {:.6g}\n", bounds.low[0],
           bounds.low[1], bounds.low[2], bounds.high[0], bounds.high[1], bounds.high[2], bounds.radius);
  const std::string nodes = facts.accel == Accel::bvh ? fmt::format(", {} nodes", facts.hierarchyNodes) : "";
  printOut("kernels     need {}\nintersector {}{}; {:.0f} bytes a primitive\n\n",
           needs.empty() ? "nothing but diffuse surfaces" : needs, name(facts.accel), nodes, facts.bytesPerPrimitive);
}

// One row per method: its kernels and the memory of a render. A method that cannot render the scene has the reason
// instead.
void printMemory(const SceneInspection& facts) {
  printOut("memory, MB (light vertices and photon map from a few waves of light paths)\n");
  printOut("{:<6} {:<22} {:>10} {:>8} {:>8} {:>8} {:>8} {:>9} {:>8} {:>8} {:>8} {:>8} {:>9}\n", "method", "kernels",
           "bytes/path", "scene", "waves", "film", "splats", "vertices", "photons", "guide", "chains", "image",
           "total");
  for (const MethodInspection& row : facts.methods) {
    if (!row.refusal.empty()) {
      printOut("{:<6} {}\n", toString(row.method), row.refusal);
      continue;
    }
    const MemoryUse& use = row.memory.use;
    printOut("{:<6} {:<22} {:>10} {:>8} {:>8} {:>8} {:>8} {:>9} {:>8} {:>8} {:>8} {:>8} {:>9}\n", toString(row.method),
             name(row.specialization), row.memory.bytesPerPath, megabytes(use.scene), megabytes(use.waves),
             megabytes(use.film), megabytes(use.splats), megabytes(use.lightVertices), megabytes(use.photonMap),
             megabytes(use.learned), megabytes(use.chains), megabytes(use.image), megabytes(use.total()));
  }
}

// One row per method that merges.
void printMerging(const SceneInspection& facts) {
  printOut("\nfirst radius of merges (--radius auto), and the photons of an iteration that a search meets\n");
  printOut("{:<6} {:>10} {:>12} {:>8} {:>8}\n", "method", "radius", "scene units", "pixels", "photons");
  for (const MethodInspection& row : facts.methods) {
    if (!row.mergeRadius) continue;
    const MergeRadius& radius = *row.mergeRadius;
    printOut("{:<6} {:>10.4g} {:>12.4g} {:>8.2f} {:>8.2f}\n", toString(row.method), radius.first, radius.at(0),
             radius.inPixels(), radius.photonsPerSearch());
  }
}

// One row per path class and one column per method. The last line names the method for references.
void printClasses(const PathClassTable& table) {
  printOut("\npaths from light to eye (A lamp or sky, P point, spot or sun, D diffuse or rough, S smooth, E eye)\n");
  printOut("{:<16}", "class");
  for (const MethodEntry& entry : kMethods) printOut(" {:<11}", entry.name);
  printOut("\n");
  for (const PathClass& pathClass : table.classes) {
    printOut("{:<16}", pathClass.signature);
    for (const MethodEntry& entry : kMethods) printOut(" {:<11}", name(table.verdict(pathClass, entry.method)));
    printOut(" {}\n", pathClass.description);
  }
  printOut("\nreference   {}{}: {}\n", toString(table.reference.method), table.reference.biased ? " (biased)" : "",
           table.reference.reason);
}

void printNoteList(const std::vector<Note>& notes) {
  if (notes.empty()) return;
  printOut("\nnotes: what was approximated or left out\n");
  for (const Note& note : notes) printOut("{}\n", toString(note));
}

// Prints what inspectScene finds, as text or JSON. Nothing is rendered, but for a picture of the guide.
int runInspect(const InspectOptions& options) {
  if (options.json && !options.guide.pixel.empty()) {
    throw UsageError("--json and --guide: the picture of a guide has no JSON; expected one of them");
  }
  // Of the planned render only the settings that decide kernels, intersector and memory are needed.
  RenderSettings settings;
  settings.precision = static_cast<Precision>(parseChoice("--precision", options.precision, kPrecisionNames));
  settings.accel = static_cast<Accel>(parseChoice("--accel", options.accel, kAccelNames));
  settings.instancing = static_cast<Instancing>(parseChoice("--instances", options.instances, kInstancingNames));
  settings.isa = bestIsa();
  settings.threads = threadsOrAll(options.threads);
  settings.waveSize = options.wave;
  takeProgramDefaults(settings);
  // Scene and facts.
  const Scene scene = loadScene(options.scene);
  settings.limits = pathLimits(scene.defaults.maxDepth, scene.defaults.rrDepth);
  if (!options.guide.pixel.empty()) {
    writeGuidePicture(scene, settings, options.guide);
    return kExitDone;
  }
  if (!options.guide.time.empty() || !options.guide.output.empty()) {
    throw UsageError("--time and --output are for the picture of --guide X,Y");
  }
  const SceneInspection facts = inspectScene(scene, settings);
  // Output: one JSON object, or text.
  if (options.json) {
    printOut("{}\n", jsonText(inspectionJson(scene, facts), 2));
    return kExitDone;
  }
  printFacts(scene, facts);
  printMemory(facts);
  printMerging(facts);
  printClasses(facts.paths);
  printNoteList(scene.notes);
  return kExitDone;
}

}  // namespace

void addInspectCommand(CommandLine& program, int& exitCode) {
  auto options = std::make_shared<InspectOptions>();
  const Command command = program.add("inspect", "what is in a scene, and what each method can do in it");
  addSceneOptions(command, options->scene);
  command.addFlag("--json", options->json, "as JSON");
  command.add("--precision", options->precision, "of the render that is planned").showDefault();
  command.add("--accel", options->accel, "auto, small, bvh or embree").showDefault();
  command.add("--instances", options->instances, "of shape groups: auto, expand or keep").showDefault();
  command.add("--threads", options->threads, "of the render that is planned; default: all cores").between(kThreadRange);
  command.add("--wave", options->wave, "paths per wave").showDefault().between(kWaveRange);
  command.add("--guide", options->guide.pixel,
              "X,Y: render by gpt, and write a picture of the directions that it has learned where this pixel looks");
  command.add("--time", options->guide.time, "of that render; default: 10s");
  command.add("-o,--output", options->guide.output, "its file: .exr, .pfm or .png; default: SCENE.guide.exr");
  command.run([options, &exitCode] { exitCode = runInspect(*options); });
}

}  // namespace wavecrest
