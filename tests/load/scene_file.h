// Scene files for the tests: XML and meshes written to a folder of their own, loaded, and deleted again.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

#include "engine/load/load.h"
#include "tests/metrics/temporary_folder.h"

namespace wavecrest {

class Folder {
 public:
  std::filesystem::path write(const std::string& name, std::string_view content) const {
    std::filesystem::path path = folder_.folder() / name;
    std::filesystem::create_directories(path.parent_path());
    std::filesystem::remove(path);  // file systems may flush to the disk when a file is overwritten
    std::ofstream(path, std::ios::binary) << content;
    return path;
  }
  const std::filesystem::path& path() const { return folder_.folder(); }

 private:
  test::TemporaryFolder folder_;
};

constexpr std::string_view kSensor = "<sensor type=\"perspective\"/>";
constexpr std::string_view kSphere = "<shape type=\"sphere\"/>";

// The body stands between the tags of a scene of version 3, starting on line 1.
inline std::string sceneXml(std::string_view body, std::string_view version = "3.0.0") {
  return "<scene version=\"" + std::string(version) + "\">" + std::string(body) + "</scene>";
}

// As the file says it: nothing is simplified.
inline Scene load(const Folder& folder, std::string_view xml, LoadOptions options = {}) {
  options.keepAll = true;
  return loadScene(folder.write("scene.xml", xml), options);
}
inline Scene load(std::string_view xml, const LoadOptions& options = {}) { return load(Folder(), xml, options); }

// A scene of the given content with a sensor, and with a sphere unless the content has a shape.
inline Scene loadBody(const Folder& folder, std::string_view body, const LoadOptions& options = {}) {
  const bool hasShape = body.find("<shape") != std::string_view::npos;
  const bool hasSensor = body.find("<sensor") != std::string_view::npos;
  const std::string rest =
      std::string(hasSensor ? std::string_view() : kSensor) + std::string(hasShape ? std::string_view() : kSphere);
  return load(folder, sceneXml(std::string(body) + rest), options);
}
inline Scene loadBody(std::string_view body, const LoadOptions& options = {}) {
  return loadBody(Folder(), body, options);
}

// The error that loading must end in. `file` is the name of the file at fault, relative to the folder.
inline void expectError(const Folder& folder, std::string_view xml, int line, std::string_view text,
                        std::string_view file = "scene.xml", const LoadOptions& options = {}) {
  try {
    load(folder, xml, options);
  } catch (const LoadError& error) {
    EXPECT_EQ(error.location.line, line) << error.what();
    EXPECT_EQ(error.location.file, (folder.path() / file).string()) << error.what();
    EXPECT_NE(error.text.find(text), std::string::npos) << error.what() << "\nexpected in it: " << text;
    EXPECT_NE(error.text.find("; expected"), std::string::npos) << error.what();
    EXPECT_EQ(error.what(), toString(error.location) + ": " + error.text);
    return;
  }
  ADD_FAILURE() << "loaded without an error; expected: " << text;
}
inline void expectError(std::string_view xml, int line, std::string_view text) {
  expectError(Folder(), xml, line, text);
}
// As above for what stands on line 2 of a scene that is otherwise complete.
inline void expectErrorOnLine2(std::string_view body, std::string_view text) {
  expectError(sceneXml("\n" + std::string(body) + "\n" + std::string(kSensor) + std::string(kSphere)), 2, text);
}

inline const Sphere& onlySphere(const Scene& scene) {
  EXPECT_EQ(scene.shapes.size(), 1u);
  return std::get<Sphere>(scene.shapes.at(0).kind);
}

// A sphere whose reflectance is a texture.
inline std::string texturedSphere(std::string_view texture) {
  return "<shape type=\"sphere\"><bsdf type=\"diffuse\">" + std::string(texture) + "</bsdf></shape>";
}

}  // namespace wavecrest
