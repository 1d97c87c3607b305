// Files of one render: the image under each requested name, snapshots beside the first, the statistics.
//
// All names are checked before the render begins. A file that cannot be written after all is reported and does not keep
// the others from being written. With a checkpoint, statistics and snapshots go on from it.
#pragma once

#include <chrono>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "cli/progress.h"
#include "engine/scene/scene.h"
#include "engine/session/session.h"
#include "engine/session/snapshots.h"
#include "metrics/image/image.h"
#include "metrics/image/image_io.h"
#include "wavecrest/results.h"

namespace wavecrest {

struct OutputNames {
  std::vector<std::string> images;  // at least one, but of a part
  std::string stats;                // empty: none; - is stdout
  std::string snapshotEvery;        // empty: no snapshots; they are named after the first image
  std::string checkpoint;           // empty: none
  double exposure = 0;              // stops, of PNG images
  bool partial = false;             // images are written before there is a whole one
};

// Throws UsageError where a name cannot be written, or is that of an input (a file of the scene, or the reference of
// --until-ssim, if there is one) or of another output.
void checkOutputs(const OutputNames& names, const std::vector<std::string>& inputs, const std::string& reference);

// What a render has made so far: a session, or all processes of a render together.
struct Rendered {
  RenderStatistics statistics;
  std::function<Image()> image;
  nlohmann::ordered_json processes;  // a row for each; null for a session
};
Rendered renderedBy(const Session& session);  // which must outlive it

class RenderOutputs {
 public:
  // All must outlive it.
  RenderOutputs(const OutputNames& names, const Scene& scene, const RenderSettings& settings, double loadSeconds,
                ProgressKind kind)
      : names_(names), scene_(scene), settings_(settings), loadSeconds_(loadSeconds), kind_(kind) {}

  // Before there is a whole image, a line says that the snapshot is left out.
  void writeSnapshot(const Rendered& rendered, unsigned number);
  // Whether there is an image to write: a whole one, or any with --partial.
  bool hasImage(const RenderStatistics& statistics) const;
  // Images and statistics at the end of the render.
  void write(const Rendered& rendered);
  // Statistics alone.
  void writeStats(const Rendered& rendered);
  // Images and statistics so far, while the render goes on; no statistics on stdout. Before there is a whole image, a
  // line says that nothing is saved.
  void save(const Rendered& rendered);
  // The checkpoint, if one was asked for and there are paths to keep.
  void writeCheckpoint(const Session& session) { writeCheckpoint(session, names_.checkpoint); }
  // The same as a file of this name; empty: none. Returns whether it was written.
  bool writeCheckpoint(const Session& session, const std::string& file);
  // Takes over what writeCheckpoint has noted of an earlier part of the render.
  void goOnFrom(const nlohmann::ordered_json& notes, const Session& session);
  // Of all processes of the render, where there are several.
  void setResumedFrom(uint64_t iterations) { resumedFrom_ = iterations; }
  // The number of the next snapshot. Where an earlier part had another schedule, those that would have been due by now
  // are left out.
  unsigned nextSnapshot(const SnapshotSchedule& schedule, const Session& session);
  // What was reached of a quality that was asked for; goes into the statistics.
  void setUntil(nlohmann::ordered_json until) { until_ = std::move(until); }
  const nlohmann::ordered_json& until() const { return until_; }
  // Whether some file could not be written when it was last tried.
  bool failed() const { return !failed_.empty(); }

 private:
  nlohmann::ordered_json stats(const RenderStatistics& statistics, const nlohmann::ordered_json& processes) const;
  double wallSeconds() const;
  void write(const Rendered& rendered, const std::string& statsFile, bool images);  // statsFile: empty for none
  void writeImages(const Rendered& rendered, const Metadata& metadata);
  // Runs a step that writes the file. Returns whether it did.
  template <class Step>
  bool attempt(const std::string& file, Step step);

  const OutputNames& names_;
  const Scene& scene_;
  const RenderSettings& settings_;
  const double loadSeconds_;
  const ProgressKind kind_;
  const std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::vector<SnapshotRecord> snapshots_;
  unsigned nextSnapshot_ = 0;     // its number
  nlohmann::ordered_json until_;  // null: none was asked for
  double earlierSeconds_ = 0;     // on the wall, of processes that rendered earlier parts
  bool sameSchedule_ = false;     // of snapshots as in those
  uint64_t resumedFrom_ = 0;      // iterations
  std::set<std::string> failed_;  // files
};

}  // namespace wavecrest
