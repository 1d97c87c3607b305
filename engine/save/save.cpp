#include "engine/save/save.h"

#include <fmt/core.h>

#include <sstream>
#include <system_error>

#include "engine/save/sections.h"
#include "engine/scene/hash_text.h"
#include "metrics/image/atomic_file.h"
#include "metrics/image/image.h"

namespace wavecrest {

namespace {

namespace fs = std::filesystem;

std::string textOf(const pugi::xml_document& document) {
  std::ostringstream text;
  document.save(text, "  ", pugi::format_indent | pugi::format_no_declaration);
  return std::move(text).str();
}

}  // namespace

SavePlan planSave(const Scene& scene, const fs::path& xml) {
  if (xml.stem().empty()) throw std::runtime_error(xml.string() + ": expected the name of an XML file");
  const std::string folder = xml.stem().string() + "-files";
  SavePlan plan{.folder = xml.parent_path() / folder, .files = {}, .notes = {}};
  pugi::xml_document document;
  document.append_child(pugi::node_comment)
      .set_value(
          fmt::format(" {}, as wavecrest reads it; scene_hash {} ", xmlName(scene.name), hashText(scene.hash)).c_str());
  pugi::xml_node root = document.append_child("scene");
  root.append_attribute("version") = "3.0.0";

  AssetFiles assets(plan.folder, folder);
  SaveContext context{.scene = scene, .root = root, .assets = assets, .notes = plan.notes, .names = {}};
  saveIntegrator(context);
  saveSensor(context);
  saveTextures(context);
  saveMaterials(context);
  saveShapes(context);
  saveEmitters(context);

  plan.files = assets.takeFiles();
  plan.files.push_back({xml, [xml, text = textOf(document)] { writeFileAtomically(xml.string(), text); }});
  return plan;
}

void saveScene(const SavePlan& plan) {
  std::error_code error;
  if (plan.files.size() > 1) fs::create_directories(plan.folder, error);
  if (error) throw ImageError(plan.folder.string(), "cannot be made: " + error.message(), "expected a writable folder");
  for (const SavedFile& file : plan.files) file.write();
}

}  // namespace wavecrest
