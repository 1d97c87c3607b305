// A scene that is written to a folder of its own and read again.
#pragma once

#include "engine/save/save.h"
#include "tests/load/scene_file.h"

namespace wavecrest {

inline Scene savedAndLoaded(const Scene& scene) {
  const Folder folder;
  saveScene(planSave(scene, folder.path() / "saved.xml"));
  return loadScene(folder.path() / "saved.xml", {.keepAll = true});
}

}  // namespace wavecrest
