// Writes a Scene as plain Mitsuba 3 XML, so that other programs can render what wavecrest understood of a scene file.
//
// In: a Scene. Out: NAME.xml and a folder NAME-files beside it with a binary PLY for each mesh and a PNG or EXR for
// each bitmap. Numbers have as many digits as a double needs: loadScene reads the same Scene from the file, to the bit,
// but for what README.md lists. A scene is loaded with LoadOptions::keepAll for that, or features that change no image
// are missing in the file.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "engine/load/xml_document.h"
#include "engine/scene/scene.h"

namespace wavecrest {

struct SavedFile {
  std::filesystem::path path;
  std::function<void()> write;  // replaces the file; throws ImageError where that fails
};

struct SavePlan {
  std::filesystem::path folder;  // of all files but the XML
  std::vector<SavedFile> files;  // the XML file is the last one
  std::vector<Note> notes;       // what Mitsuba 3 does not know
};

// What would be written; writes nothing, so that the names can be checked first. `scene` must outlive the plan. Throws
// std::runtime_error where `xml` has no stem, SceneError where the XML file would be beyond what the loader reads.
SavePlan planSave(const Scene& scene, const std::filesystem::path& xml, const XmlLimits& limits = {});

// Makes the folder and writes all files. Throws ImageError.
void saveScene(const SavePlan& plan);

}  // namespace wavecrest
