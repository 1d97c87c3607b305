// Meshes and bitmaps of a scene that is written: each gets a file in the folder beside the XML.
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/save/ply_file.h"
#include "engine/save/save.h"

namespace wavecrest {

// How a bitmap is stored: what its texture has to say about it.
struct StoredBitmap {
  std::string filename;  // as the XML names it
  bool raw = false;      // codes are light: no sRGB curve
};

class AssetFiles {
 public:
  // name: the folder's, relative to the XML file.
  AssetFiles(std::filesystem::path folder, std::string name) : folder_(std::move(folder)), name_(std::move(name)) {}

  // A PLY file. The mesh must outlive the plan unless it is moved in. Returns the name.
  std::string addMesh(const Mesh& mesh, PlyContent content);
  std::string addMesh(Mesh&& mesh, PlyContent content);
  // A PNG if 8-bit codes give the same floats, otherwise an EXR. A bitmap of several textures is stored once.
  // isData: of numbers or normals, not of colours.
  StoredBitmap addBitmap(const std::shared_ptr<const Bitmap>& bitmap, bool isData);
  // The same for an environment map, which is never raw: its 8-bit codes have the sRGB curve. Returns the name.
  std::string addEnvironment(const std::shared_ptr<const Bitmap>& bitmap);

  std::vector<SavedFile> takeFiles() { return std::move(files_); }

 private:
  std::string add(const std::string& file, std::function<void(const std::string& path)> write);
  // curves: whether 8-bit codes are raw, in the order in which they are tried. An EXR has the first one's flag.
  StoredBitmap store(const std::shared_ptr<const Bitmap>& bitmap, std::span<const bool> curves);

  std::filesystem::path folder_;
  std::string name_;
  std::vector<SavedFile> files_;
  std::map<const Bitmap*, StoredBitmap> bitmaps_, environments_;
  size_t meshes_ = 0;
};

}  // namespace wavecrest
