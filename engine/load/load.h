// Reads a scene file: Mitsuba 3 XML, and by automatic upgrade the names of versions 0.4 to 2.x, into a Scene.
//
// In: a path to an XML file; the meshes and textures it names are found relative to the file that names them.
// Out: a complete, checked Scene: every index valid, every number finite, every light of positive area.
// Input is untrusted: whatever the bytes, the result is a Scene or a LoadError that names file and line.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>

#include "engine/scene/scene.h"
#include "engine/scene/scene_error.h"

namespace wavecrest {

// What is wrong with an input file; what() reads "FILE:LINE: what is wrong; what was expected", of the
// whole file (line 0) "FILE: ...".
class LoadError : public std::runtime_error {
 public:
  LoadError(const SourceLocation& where, const std::string& message)
      : std::runtime_error(toString(where) + ": " + message), location(where), text(message) {}

  SourceLocation location;
  std::string text;  // without the location
};

// A file that does not exist: named in another one at `where`, or at line 0 the scene file itself.
class MissingFileError : public LoadError {
 public:
  MissingFileError(const SourceLocation& where, const std::filesystem::path& missing)
      : LoadError(where, where.line == 0 ? "no such file; expected a Mitsuba scene file"
                                         : "file \"" + missing.string() + "\" not found; expected an existing file"),
        file(missing) {}

  std::filesystem::path file;
};

// What stands for a parameter where the file is silent, as far as its reader says so at once; none of other elements.
using ParameterFallback = std::variant<std::monostate, bool, int64_t, double, std::string_view>;

// A parameter that a reader asked an object for, whether or not the file has it. Valid during the call.
struct AskedParameter {
  std::string_view object, type;  // <bsdf type="diffuse">
  std::string_view name;
  ParameterFallback fallback{};
};

struct LoadOptions {
  // Values of $name, stronger than the file's <default>. A name that the scene never uses is an error, unless
  // unusedDefine is there for it.
  std::map<std::string, std::string> defines{};
  // Skip what is not supported and list it in Scene::warnings. Malformed input is an error all the same.
  bool lenient = false;
  // Width and height instead of the film's; a crop window, being in pixels of the old size, is dropped. The field of
  // view follows the new aspect ratio by the sensor's fov_axis. One of them may be 0: the file's aspect ratio says.
  std::optional<std::array<uint32_t, 2>> filmSize{};
  // Keep what changes no image (engine/load/simplify.h): for those who ask what the file says.
  bool keepAll = false;
  // Called for each parameter that is asked for: what the loader knows, for the reference of the scene language.
  std::function<void(const AskedParameter&)> asked{};
  // Called for each name of `defines` that the scene never uses.
  std::function<void(const std::string&)> unusedDefine{};
};

// "-" is standard input; files are then found relative to the current folder.
Scene loadScene(const std::filesystem::path& xml, const LoadOptions& options = {});

}  // namespace wavecrest
