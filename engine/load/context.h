// What all readers share while one scene is loaded: the XML, the scene being built, and what was read already.
#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include "engine/load/load.h"
#include "engine/load/xml_document.h"

namespace wavecrest {

class MeshesAhead;

// An image file as read by readBitmap.
struct BitmapFile {
  std::shared_ptr<const Bitmap> bitmap;
  bool encoded = false;  // the file has 8 or 16 bits, of the sRGB curve, whether or not that is undone
};

struct LoadContext {
  const LoadOptions& options;
  const XmlDocument& document;
  Scene scene;

  // An object that is referenced many times is read once.
  std::map<const XmlElement*, uint32_t> materials{};
  std::map<const XmlElement*, uint32_t> textures{};
  // What stands in for a texture where a number is asked for, by the texture and by asMitsuba3 (scalarTextureOf).
  std::map<std::pair<uint32_t, bool>, uint32_t> scalarTextures{};
  std::set<const XmlElement*> reading{};        // objects being read, to find reference cycles
  std::map<std::string, BitmapFile> bitmaps{};  // by path and colour treatment
  std::map<std::string, std::shared_ptr<const std::vector<char>>> meshArchives{};  // files of many meshes, by path
  std::shared_ptr<MeshesAhead> meshesAhead{};
  std::set<const XmlElement*> areaLights{};         // that shapes have
  std::string meshAttribute{};                      // that the shape being read asks its mesh for, and
  std::shared_ptr<const Bitmap> attributeBitmap{};  // what became of it
  std::map<const XmlElement*, uint32_t> groups{};   // of the scene, by their definitions
  uint32_t shapeGroup = kNone;                      // the one whose shapes are being read
  uint32_t defaultMaterial[2] = {kNone, kNone};     // of surfaces, of lights
  std::set<std::string> warned{};                   // Scene::warnings of the readers
  // Indices in Scene::notes, by what and effect.
  std::map<std::pair<std::string, std::string>, size_t> noted{};

  // Follows <ref>; any other element is itself.
  const XmlElement& resolve(const XmlElement& element) const;
  // The path of a file named in the XML, relative to a <path>, the last one first, else to the scene file (as Mitsuba
  // takes it, also in included files), else to the file that names it. The first that exists; if none does, the one
  // beside the scene file.
  std::filesystem::path findFile(std::string_view name, const XmlElement& namedIn) const;
  // Names a file in Scene::files, if it exists.
  void listFile(const std::filesystem::path& path);
  // Both at once.
  std::filesystem::path resolvePath(std::string_view name, const XmlElement& namedIn);

  // Something well-formed that wavecrest does not support: an error, or with --lenient a warning after which the
  // caller goes on without it.
  void unsupported(const SourceLocation& where, const std::string& message);
  void warn(const SourceLocation& where, const std::string& message);
  // Something that is approximated or left out and changes the picture little or not at all: listed in Scene::notes,
  // where equal notes of several places become one.
  void note(const SourceLocation& where, const std::string& what, const std::string& effect);
};

// Marks an object as being read for its lifetime; throws if it already is, that is, if it contains itself,
// or if references chain too deep for the stack.
class ReadingGuard {
 public:
  ReadingGuard(LoadContext& context, const XmlElement& object);
  ~ReadingGuard() { context_.reading.erase(&object_); }
  ReadingGuard(const ReadingGuard&) = delete;
  ReadingGuard& operator=(const ReadingGuard&) = delete;

 private:
  LoadContext& context_;
  const XmlElement& object_;
};

}  // namespace wavecrest
