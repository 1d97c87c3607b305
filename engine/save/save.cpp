#include "engine/save/save.h"

#include <fmt/core.h>

#include <algorithm>
#include <sstream>
#include <system_error>

#include "engine/save/sections.h"
#include "engine/scene/hash_text.h"
#include "engine/scene/scene_error.h"
#include "metrics/image/atomic_file.h"
#include "metrics/image/image.h"

namespace wavecrest {

namespace {

namespace fs = std::filesystem;

// Counts elements, and how deep they nest.
struct ElementCounter : pugi::xml_tree_walker {
  bool for_each(pugi::xml_node& node) override {
    if (node.type() != pugi::node_element) return true;
    ++elements;
    deepest = std::max(deepest, depth() + 1);
    return true;
  }
  size_t elements = 0;
  int deepest = 0;
};

// The text of the file. SceneError where the loader would refuse it.
std::string textOf(pugi::xml_document& document, const fs::path& xml, const XmlLimits& limits) {
  const auto require = [&](size_t has, size_t most, const char* what) {
    if (has <= most) return;
    throw SceneError({xml.string(), 0},
                     fmt::format("would have {} {}; expected at most {}, or it could not be read", has, what, most));
  };
  ElementCounter counter;
  document.traverse(counter);
  require(counter.elements, limits.elements, "elements");
  require(static_cast<size_t>(counter.deepest), static_cast<size_t>(limits.nesting), "levels of elements");
  std::ostringstream stream;
  document.save(stream, "  ", pugi::format_indent | pugi::format_no_declaration);
  std::string text = std::move(stream).str();
  require(text.size(), limits.bytes, "bytes");
  return text;
}

}  // namespace

SavePlan planSave(const Scene& scene, const fs::path& xml, const XmlLimits& limits) {
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
  plan.files.push_back({xml, [xml, text = textOf(document, xml, limits)] { writeFileAtomically(xml.string(), text); }});
  return plan;
}

void saveScene(const SavePlan& plan) {
  std::error_code error;
  if (plan.files.size() > 1) fs::create_directories(plan.folder, error);
  if (error) throw ImageError(plan.folder.string(), "cannot be made: " + error.message(), "expected a writable folder");
  for (const SavedFile& file : plan.files) file.write();
}

}  // namespace wavecrest
