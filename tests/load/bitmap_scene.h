// Scenes with a bitmap in a folder of its own, for tests of what a bitmap becomes and of the formats of its file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tests/load/scene_file.h"

namespace wavecrest {

// A sphere whose reflectance is this file, with further options of the bitmap.
inline Scene sceneWithBitmap(const Folder& folder, const std::string& file, std::string_view options = "") {
  return loadBody(folder, texturedSphere("<texture name=\"reflectance\" type=\"bitmap\"><string name=\"filename\" "
                                         "value=\"" +
                                         file + "\"/>" + std::string(options) + "</texture>"));
}
inline BitmapTexture bitmapOf(const Folder& folder, const std::string& file, std::string_view options = "") {
  return std::get<BitmapTexture>(sceneWithBitmap(folder, file, options).textures.at(0).kind);
}

// content: of the bitmap's element.
inline void expectTextureError(const Folder& folder, std::string_view content, std::string_view text) {
  expectError(
      folder,
      sceneXml("\n" +
               texturedSphere("<texture name=\"reflectance\" type=\"bitmap\">" + std::string(content) + "</texture>") +
               std::string(kSensor)),
      2, text);
}

}  // namespace wavecrest
