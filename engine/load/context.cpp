#include "engine/load/context.h"

#include "engine/load/values.h"

namespace wavecrest {

const XmlElement& LoadContext::resolve(const XmlElement& element) const {
  if (element.tag != "ref") return element;
  const std::string* id = element.find("id");
  if (!id) throw LoadError(element.location(), "<ref> has no id; expected the id of an object");
  const auto target = document.ids.find(*id);
  if (target == document.ids.end()) {
    throw LoadError(element.location(), "no object has the id " + inQuotes(*id) + "; expected the id of an object");
  }
  return *target->second;
}

std::filesystem::path LoadContext::findFile(std::string_view name, const XmlElement& namedIn) const {
  const auto folderOf = [](const std::string& file) { return std::filesystem::path(file).parent_path(); };
  std::filesystem::path besideScene = (folderOf(document.files.front()) / name).lexically_normal();
  // Each <path> comes before all that Mitsuba searched until then, so the last one is first.
  std::vector<std::filesystem::path> candidates;
  for (const std::filesystem::path& folder : document.searchPaths) candidates.insert(candidates.begin(), folder / name);
  candidates.push_back(besideScene);
  candidates.push_back(folderOf(*namedIn.file) / name);
  for (const std::filesystem::path& candidate : candidates) {
    std::error_code error;
    if (std::filesystem::exists(candidate, error)) return candidate.lexically_normal();
  }
  return besideScene;
}

void LoadContext::listFile(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::exists(path, error)) scene.files.push_back(path.string());
}

std::filesystem::path LoadContext::resolvePath(std::string_view name, const XmlElement& namedIn) {
  std::filesystem::path path = findFile(name, namedIn);
  listFile(path);
  return path;
}

void LoadContext::unsupported(const SourceLocation& where, const std::string& message) {
  if (!options.lenient) throw LoadError(where, message);
  warn(where, message);
}

void LoadContext::warn(const SourceLocation& where, const std::string& message) {
  // Some objects are read twice: meshes ahead of their shapes, materials again for each shape with an attribute.
  const auto [warning, isNew] = warned.insert(toString(where) + ": " + message);
  if (isNew) scene.warnings.push_back(*warning);
}

void LoadContext::note(const SourceLocation& where, const std::string& what, const std::string& effect) {
  const auto [known, isNew] = noted.try_emplace(std::pair(what, effect), scene.notes.size());
  if (isNew) {
    scene.notes.push_back({.source = where, .what = what, .effect = effect});
  } else {
    ++scene.notes[known->second].count;
  }
}

ReadingGuard::ReadingGuard(LoadContext& context, const XmlElement& object) : context_(context), object_(object) {
  constexpr size_t kDeepest = 64;
  if (context.reading.size() >= kDeepest) {
    throw LoadError(object.location(), "references nest deeper than " + std::to_string(kDeepest) +
                                           "; expected a shorter chain of objects");
  }
  if (!context.reading.insert(&object).second) {
    throw LoadError(object.location(),
                    "<" + object.tag + "> contains itself through a reference; expected references without a cycle");
  }
}

}  // namespace wavecrest
