#include "cli/render_outputs.h"

#include <fmt/core.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <new>
#include <optional>
#include <string_view>

#include "bench/campaign/render_stats.h"
#include "bench/checkpoint/checkpoint.h"
#include "bench/film_image.h"
#include "bench/json_text.h"
#include "bench/results/snapshot_notes.h"
#include "bench/whole_number.h"
#include "cli/commands.h"
#include "cli/file_check.h"
#include "cli/messages.h"
#include "metrics/image/real_name.h"
#include "metrics/image/srgb.h"

namespace wavecrest {
namespace {

namespace fs = std::filesystem;

// NAME.0007.exr beside the output NAME.exr.
std::string snapshotFile(const std::string& image, unsigned number) {
  const fs::path path(image);
  return (path.parent_path() / fmt::format("{}.{:04}.exr", path.stem().string(), number)).string();
}

// Whether the file is where some snapshot of the image, of any number, would be written.
bool isSnapshotOf(const std::string& image, const std::string& file) {
  const fs::path stem = fs::path(file).stem();  // NAME.0007
  const std::string digits = stem.extension().string();
  if (digits.size() < 2) return false;
  const std::optional<unsigned> number = wholeNumber<unsigned>(std::string_view(digits).substr(1));
  return number && realName(snapshotFile(image, *number)) == realName(file);
}

bool isPng(const std::string& file) { return extensionOf(file) == ".png"; }

}  // namespace

void checkOutputs(const OutputNames& names, const std::vector<std::string>& inputs, const std::string& reference) {
  // Inputs, and every output by itself and against the others.
  if (names.exposure != 0 && std::none_of(names.images.begin(), names.images.end(), isPng)) {
    throw UsageError("--exposure: is for PNG images alone; expected -o FILE.png");
  }
  FileCheck files;
  for (const std::string& input : inputs) files.input("the scene", input);
  if (!reference.empty()) files.input("--reference", reference);
  for (const std::string& image : names.images) files.image("-o", image);
  if (!names.stats.empty()) files.output("--stats", names.stats);
  if (!names.checkpoint.empty()) files.output("--checkpoint", names.checkpoint);
  // How many snapshots there will be is not known, so no other file may have the name of any snapshot. A process that
  // writes no images has none.
  if (names.snapshotEvery.empty() || names.images.empty()) return;
  std::vector<std::string> others(names.images.begin() + 1, names.images.end());
  others.push_back(names.stats);
  others.push_back(names.checkpoint);
  others.insert(others.end(), inputs.begin(), inputs.end());
  for (const std::string& other : others) {
    if (other.empty() || !isSnapshotOf(names.images.front(), other)) continue;
    throw UsageError(fmt::format("{}: is the name of a snapshot of {} too; expected a file of its own", other,
                                 names.images.front()));
  }
}

// A file that cannot be written is reported, and remembered until it is written after all, but does not end the render,
// nor keep others from being written. All that is made for the file alone, such as its image, belongs to the step:
// memory may be short for a while.
template <class Step>
bool RenderOutputs::attempt(const std::string& file, Step step) {
  try {
    step();
    failed_.erase(file);
    return true;
  } catch (const std::bad_alloc&) {
    tell("wavecrest: error: {}: no memory to write it; expected more memory, or a smaller film", file);
  } catch (const std::exception& error) {
    tell("wavecrest: error: {}", error.what());
  }
  failed_.insert(file);
  return false;
}

Rendered renderedBy(const Session& session) {
  return {.statistics = session.statistics(), .image = [&session] { return filmImage(session); }, .processes = {}};
}

bool RenderOutputs::hasImage(const RenderStatistics& statistics) const {
  return statistics.hasWholeImage() || (names_.partial && statistics.paths > 0);
}

void RenderOutputs::writeSnapshot(const Rendered& rendered, unsigned number) {
  nextSnapshot_ = number + 1;
  const std::string file = snapshotFile(names_.images.front(), number);
  const RenderStatistics& statistics = rendered.statistics;
  if (!hasImage(statistics)) {
    noteLine(kind_, {{"left_out", file}, {"render_seconds", statistics.renderSeconds}},
             fmt::format("{}: left out, as there was no whole pass over the film in {:.2g} s", file,
                         statistics.renderSeconds));
    return;
  }
  snapshots_.push_back(
      {.number = number, .renderSeconds = statistics.renderSeconds, .iterations = statistics.iterations, .file = file});
  const bool written =
      attempt(file, [&] { writeExr(file, rendered.image(), statsMetadata(stats(statistics, rendered.processes))); });
  if (!written) snapshots_.pop_back();  // no record of it
}

void RenderOutputs::write(const Rendered& rendered) { write(rendered, names_.stats, true); }

void RenderOutputs::writeStats(const Rendered& rendered) { write(rendered, names_.stats, false); }

// Stdout takes one JSON object, the last.
void RenderOutputs::save(const Rendered& rendered) {
  if (hasImage(rendered.statistics)) {
    write(rendered, names_.stats == kStandardStream ? "" : names_.stats, true);
  } else {
    noteLine(kind_, {{"left_out", "save"}}, "not saved, as there was no whole pass over the film yet");
  }
}

void RenderOutputs::write(const Rendered& rendered, const std::string& statsFile, bool images) {
  // The statistics go into the images as attributes, and into a file of their own.
  nlohmann::ordered_json all;
  attempt(names_.stats.empty() ? "the statistics" : names_.stats, [&] {
    all = stats(rendered.statistics, rendered.processes);
    if (!until_.is_null()) all["until"] = until_;
  });
  const Metadata metadata = statsMetadata(all);
  if (images) writeImages(rendered, metadata);
  if (!statsFile.empty() && !all.is_null()) {
    attempt(statsFile, [&] { writeText(statsFile, jsonText(all, 2) + "\n"); });
  }
}

// The image is made once, under the first name that there is memory for it.
void RenderOutputs::writeImages(const Rendered& rendered, const Metadata& metadata) {
  std::optional<Image> image;
  for (const std::string& name : names_.images) {
    attempt(name, [&] {
      if (!image) image = rendered.image();
      WritingProgress progress(kind_, name);
      const auto show = [&](double fraction) { progress.show(fraction); };
      if (isPng(name)) {
        writePng(name, encodeSrgb8(*image, names_.exposure));
      } else {
        writeImage(name, *image, metadata, show);
      }
    });
  }
}

bool RenderOutputs::writeCheckpoint(const Session& session, const std::string& file) {
  if (file.empty() || session.statistics().paths == 0) return false;
  return attempt(file, [&] {
    // The notes are what goOnFrom reads, time, schedule and snapshots so far, and the statistics for `merge`.
    const nlohmann::ordered_json notes = {{"wall_seconds", wallSeconds()},
                                          {"snapshot_every", names_.snapshotEvery},
                                          {"snapshots", snapshotNotes(snapshots_)},
                                          {"next_snapshot", nextSnapshot_},
                                          {"stats", stats(session.statistics(), {})}};
    wavecrest::writeCheckpoint(file, scene_, settings_, session, notes);
  });
}

void RenderOutputs::goOnFrom(const nlohmann::ordered_json& notes, const Session& session) {
  earlierSeconds_ = notes.at("wall_seconds").get<double>();
  snapshots_ = snapshotsOfNotes(notes.at("snapshots"));
  nextSnapshot_ = notes.value("next_snapshot", 0u);  // which sums of parts have not
  sameSchedule_ = notes.at("snapshot_every") == names_.snapshotEvery;
  resumedFrom_ = session.statistics().iterations;
}

unsigned RenderOutputs::nextSnapshot(const SnapshotSchedule& schedule, const Session& session) {
  // With the schedule of the earlier part, numbers simply go on, also after snapshots that were left out. A part
  // without snapshots replaces none.
  if (sameSchedule_ || names_.snapshotEvery.empty()) return nextSnapshot_;
  // With another schedule, the first snapshot is the next that is not due yet.
  nextSnapshot_ = schedule.firstAfter(session.progressSeconds(), session.statistics().iterations);
  // Files of snapshots from that number on will be replaced, so their records go.
  std::erase_if(snapshots_, [&](const SnapshotRecord& snapshot) { return snapshot.number >= nextSnapshot_; });
  return nextSnapshot_;
}

// Seconds on the wall, of this process and of those that rendered earlier parts.
double RenderOutputs::wallSeconds() const {
  return earlierSeconds_ + std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
}

nlohmann::ordered_json RenderOutputs::stats(const RenderStatistics& statistics,
                                            const nlohmann::ordered_json& processes) const {
  auto stats = renderStats(scene_, settings_, statistics, loadSeconds_, wallSeconds(), snapshots_);
  if (!names_.checkpoint.empty()) stats["resumed_from"] = resumedFrom_;
  stats["notes"] = notesSoFar();
  stats["decisions"] = decisionsJson(scene_, settings_, statistics);
  if (processes.is_null()) return stats;
  // Of all processes: threads add up, and there is no share.
  uint64_t threads = 0;
  for (const auto& process : processes) threads += process.at("threads").get<uint64_t>();
  stats["threads"] = threads;
  stats["processes"] = processes.size();
  stats["process_list"] = processes;
  stats.erase("part");
  stats.erase("first_iteration");
  return stats;
}

}  // namespace wavecrest
