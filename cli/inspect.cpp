// wavecrest inspect: what a scene asks of the program, and what each method can do in it.
#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "cli/commands.h"
#include "cli/option_values.h"
#include "cli/scene_options.h"
#include "engine/inspection.h"

namespace wavecrest {
namespace {

using nlohmann::ordered_json;

struct InspectOptions {
  SceneOptions scene;
  std::string precision = "float", accel = "auto";
  uint32_t threads = 0, wave = RenderSettings{}.waveSize;
  bool json = false;
};

std::string name(Specialization specialization) {
  return std::string(kSpecializationNames[static_cast<size_t>(specialization)]);
}
std::string name(Accel accel) { return std::string(kAccelNames[static_cast<size_t>(accel)]); }
std::string name(Verdict verdict) { return std::string(kVerdictNames[static_cast<size_t>(verdict)]); }

// ---- JSON -----------------------------------------------------------------------------------------------------------

ordered_json toJson(const MethodInspection& row) {
  if (!row.refusal.empty()) return {{"refused", row.refusal}};
  const MemoryUse& use = row.memory.use;
  return {{"bytes_per_path", row.memory.bytesPerPath},
          {"scene_bytes", use.scene},
          {"wave_bytes", use.waves},
          {"film_bytes", use.film},
          {"splat_bytes", use.splats},
          {"light_vertex_bytes", use.lightVertices},
          {"photon_map_bytes", use.photonMap},
          {"chain_bytes", use.chains},
          {"total_bytes", use.total()}};
}

ordered_json toJson(const Scene& scene, const SceneInspection& facts) {
  ordered_json specializations, memory, classes = ordered_json::array();
  for (const MethodInspection& row : facts.methods) {
    const std::string method(toString(row.method));
    specializations[method] = name(row.specialization);
    memory[method] = toJson(row);
  }
  for (const PathClass& pathClass : facts.paths.classes) {
    ordered_json verdicts;
    for (const Method method : facts.paths.methods) {
      verdicts[std::string(toString(method))] = name(facts.paths.verdict(pathClass, method));
    }
    classes.push_back({{"class", pathClass.signature}, {"description", pathClass.description}, {"methods", verdicts}});
  }
  const BoundingSphere& bounds = facts.bounds;
  const auto vec = [](const double(&a)[3]) { return ordered_json{a[0], a[1], a[2]}; };
  return {{"scene", scene.name},
          {"features",
           {{"bsdfs", facts.bsdfs},
            {"lights", facts.lights},
            {"textures", facts.textures},
            {"sensor", facts.sensor},
            {"filter", facts.filter},
            {"needs", facts.needs}}},
          {"primitives",
           {{"quads", facts.primitives.quads},
            {"triangles", facts.primitives.triangles},
            {"spheres", facts.primitives.spheres},
            {"total", facts.primitives.total()},
            {"dropped_triangles", scene.droppedTriangles}}},
          {"bounds",
           {{"min", vec(bounds.low)},
            {"max", vec(bounds.high)},
            {"center", vec(bounds.center)},
            {"radius", bounds.radius}}},
          {"specialization", name(facts.methods.front().specialization)},
          {"specializations", specializations},
          {"accel", name(facts.accel)},
          {"memory", memory},
          {"path_classes", classes},
          {"reference_method", toString(facts.paths.reference.method)},
          {"reference_biased", facts.paths.reference.biased},
          {"reference_reason", facts.paths.reference.reason}};
}

// ---- text -----------------------------------------------------------------------------------------------------------

std::string listed(const std::map<std::string, size_t>& counts) {
  std::string text;
  for (const auto& [kind, count] : counts) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, kind);
  return text.empty() ? "none" : text;
}

std::string megabytes(size_t bytes) { return fmt::format("{:.2f}", static_cast<double>(bytes) / 1e6); }

void printFacts(const Scene& scene, const SceneInspection& facts) {
  const BoundingSphere& bounds = facts.bounds;
  std::string needs;
  for (const std::string& need : facts.needs) needs += (needs.empty() ? "" : "; ") + need;
  fmt::print("{}\n\n", scene.name);
  fmt::print("BSDFs       {}\nlights      {}\ntextures    {}\n", listed(facts.bsdfs), listed(facts.lights),
             listed(facts.textures));
  fmt::print("sensor      {}, {} x {}, {} filter\n", facts.sensor, scene.film.width, scene.film.height, facts.filter);
  fmt::print("primitives  {} quads, {} triangles, {} spheres\n", facts.primitives.quads, facts.primitives.triangles,
             facts.primitives.spheres);
  fmt::print("bounds      ({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g}), radius {:.6g}\n", bounds.low[0],
             bounds.low[1], bounds.low[2], bounds.high[0], bounds.high[1], bounds.high[2], bounds.radius);
  fmt::print("kernels     need {}\nintersector {}\n\n", needs.empty() ? "nothing but diffuse surfaces" : needs,
             name(facts.accel));
}

void printMemory(const SceneInspection& facts) {
  fmt::print("memory, MB (light vertices and photon map from a few waves of light paths)\n");
  fmt::print("{:<6} {:<22} {:>10} {:>8} {:>8} {:>8} {:>8} {:>9} {:>8} {:>8} {:>9}\n", "method", "kernels", "bytes/path",
             "scene", "waves", "film", "splats", "vertices", "photons", "chains", "total");
  for (const MethodInspection& row : facts.methods) {
    if (!row.refusal.empty()) {
      fmt::print("{:<6} {}\n", toString(row.method), row.refusal);
      continue;
    }
    const MemoryUse& use = row.memory.use;
    fmt::print("{:<6} {:<22} {:>10} {:>8} {:>8} {:>8} {:>8} {:>9} {:>8} {:>8} {:>9}\n", toString(row.method),
               name(row.specialization), row.memory.bytesPerPath, megabytes(use.scene), megabytes(use.waves),
               megabytes(use.film), megabytes(use.splats), megabytes(use.lightVertices), megabytes(use.photonMap),
               megabytes(use.chains), megabytes(use.total()));
  }
}

void printClasses(const PathClassTable& table) {
  fmt::print("\npaths from light to eye (A lamp or sky, P point, spot or sun, D diffuse or rough, S smooth, E eye)\n");
  fmt::print("{:<16}", "class");
  for (const Method method : table.methods) fmt::print(" {:<11}", toString(method));
  fmt::print("\n");
  for (const PathClass& pathClass : table.classes) {
    fmt::print("{:<16}", pathClass.signature);
    for (const Method method : table.methods) fmt::print(" {:<11}", name(table.verdict(pathClass, method)));
    fmt::print(" {}\n", pathClass.description);
  }
  fmt::print("\nreference   {}{}: {}\n", toString(table.reference.method), table.reference.biased ? " (biased)" : "",
             table.reference.reason);
}

int runInspect(const InspectOptions& options) {
  RenderSettings settings;
  settings.precision = static_cast<Precision>(parseChoice("--precision", options.precision, kPrecisionNames));
  settings.accel = static_cast<Accel>(parseChoice("--accel", options.accel, kAccelNames));
  settings.isa = bestIsa();
  settings.threads = options.threads != 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency());
  settings.waveSize = options.wave;
  const Scene scene = loadScene(options.scene);
  const SceneInspection facts = inspectScene(scene, settings);
  if (options.json) {
    fmt::print("{}\n", toJson(scene, facts).dump(2));
    return kExitDone;
  }
  printFacts(scene, facts);
  printMemory(facts);
  printClasses(facts.paths);
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
  command.add("--threads", options->threads, "of the render that is planned; default: all cores").between(1, 4096);
  command.add("--wave", options->wave, "paths per wave").showDefault().between(16, 1 << 20);
  command.run([options, &exitCode] { exitCode = runInspect(*options); });
}

}  // namespace wavecrest
