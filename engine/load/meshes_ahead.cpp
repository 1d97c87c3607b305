#include "engine/load/meshes_ahead.h"

#include <functional>
#include <utility>

#include "engine/load/input_file.h"
#include "engine/load/mesh_attributes.h"
#include "engine/load/mesh_shapes.h"
#include "engine/load/parameters.h"
#include "engine/tasks/parallel_for.h"

namespace wavecrest {
namespace {

// A serialized file, which holds several meshes. It is read once, before the meshes are read out of it.
struct Archive {
  std::string path;
  SourceLocation where;
  std::shared_ptr<const std::vector<char>> bytes;
  std::exception_ptr error;
};

// The reading of one mesh. Any thread may call `read`.
struct Job {
  const XmlElement* shape;
  std::function<SerializedMesh()> read;
};

// The job for a shape. Throws the LoadError that building the shape will throw.
// A job refers to its entry of `archives`, whose address a std::map keeps.
Job jobOf(LoadContext& context, const XmlElement& shape, std::map<std::string, Archive>& archives) {
  Parameters parameters(context, shape);
  const MeshFile file = meshFileOf(context, parameters);
  if (file.kind != MeshFile::Kind::serialized) return {&shape, [file] { return SerializedMesh{readMeshFile(file)}; }};
  Archive& archive = archives[file.path.string()];
  if (archive.path.empty()) archive = {.path = file.path.string(), .where = file.where, .bytes = {}, .error = {}};
  return {&shape, [&archive, index = file.index] {
            if (archive.error) std::rethrow_exception(archive.error);
            return readSerialized(*archive.bytes, archive.path, index);
          }};
}

}  // namespace

void MeshesAhead::read(LoadContext& context, const std::vector<const XmlElement*>& shapes) {
  // Collect the jobs.
  std::map<std::string, Archive> archives;
  std::vector<Job> jobs;
  for (const XmlElement* shape : shapes) {
    const std::string_view type = shape->get("type");
    if ((type != "ply" && type != "obj" && type != "serialized") || results_.contains(shape)) continue;
    try {
      if (!meshAttributeOf(context, *shape).empty()) continue;  // it changes what is read
      jobs.push_back(jobOf(context, *shape, archives));
      // Make the entry before threads start, so that they do not change the map.
      results_[shape];
    } catch (const LoadError&) {
      continue;  // building it will throw it again
    }
  }
  // One file alone gains nothing from threads.
  if (jobs.size() < 2) {
    for (const Job& job : jobs) results_.erase(job.shape);
    return;
  }

  // Read the archives, then all meshes. An error is kept until the shape is built.
  std::vector<Archive*> files;
  files.reserve(archives.size());
  for (auto& [path, archive] : archives) files.push_back(&archive);
  parallelFor(files.size(), [&](size_t i) {
    try {
      files[i]->bytes = std::make_shared<const std::vector<char>>(readInputFile(files[i]->path, files[i]->where));
    } catch (...) {
      files[i]->error = std::current_exception();
    }
  });
  parallelFor(jobs.size(), [&](size_t i) {
    Result& result = results_.find(jobs[i].shape)->second;
    try {
      result.mesh = jobs[i].read();
    } catch (...) {
      result.error = std::current_exception();
    }
  });
}

std::optional<SerializedMesh> MeshesAhead::take(const XmlElement& shape) {
  const auto found = results_.find(&shape);
  if (found == results_.end()) return std::nullopt;
  Result result = std::move(found->second);
  results_.erase(found);
  if (result.error) std::rethrow_exception(result.error);
  return std::move(result.mesh);
}

}  // namespace wavecrest
