// `mpirun -n 4 wavecrest render ...`: the processes that share a render, as the command line sees them.
//
// Every process renders a share of the iterations. The first writes images, statistics and lines of progress of the
// sum; each writes the checkpoint of its own share, FILE-I-of-N, which merges as parts do. A render on its own has no
// ranks, and all calls do what one process needs.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/ranks/ranks.h"
#include "cli/failure.h"
#include "cli/interrupt.h"
#include "cli/progress.h"
#include "cli/render_options.h"
#include "cli/render_outputs.h"
#include "engine/tasks/placement.h"

namespace wavecrest {

class RenderRanks {
 public:
  // Joins the other processes, where a launcher has started some.
  RenderRanks();

  bool several() const { return ranks_.has_value(); }
  // Whether this process writes the outputs and speaks for all.
  bool first() const { return !several() || ranks_->first(); }
  // The progress of this process.
  ProgressKind kind(ProgressKind asked) const { return first() ? asked : ProgressKind::silent; }
  std::function<uint64_t()> pathsElsewhere() const;

  // Makes the options those of this process: threads as the launcher has bound it, a checkpoint of its own, outputs of
  // the first alone. Throws UsageError for options that several processes cannot have.
  void adapt(RenderOptions& options);
  // The settings of this process' share.
  RenderSettings share(const RenderSettings& settings, const Scene& scene, ProgressKind kind) const;
  // Has all processes cut paths as the first one does: last bits may depend on it. They learn each other's threads.
  void cutAlike(RenderSettings& settings);
  // The placement of this process' threads: those of processes that may run on the same processors lie beside them.
  // After cutAlike.
  Placement pinned(uint32_t threads, ProgressKind kind) const;
  // Runs a step that every process runs. Where it fails in one, the first says so, and all throw SharedFailure.
  void together(const std::function<void()>& step);
  // Requires that all render the same, and returns the number of the first snapshot for all. The first process' outputs
  // get the iterations that the processes go on from.
  unsigned agree(const nlohmann::ordered_json& identity, const Session& session, unsigned firstSnapshot,
                 RenderOutputs& outputs);

  // While it lives, others hear of signals and paths of the session that renders, and this process of theirs. The share
  // is saved where all are to stop while this process, which is done, waits for others.
  class Watch {
   public:
    Watch(RenderRanks& ranks, InterruptGuard& guard, const Session& session, RenderOutputs& outputs);
    ~Watch();
    Watch(const Watch&) = delete;
    Watch& operator=(const Watch&) = delete;

   private:
    RenderRanks& ranks_;
  };

  // At a snapshot: writes it, or contributes to it.
  void snapshot(const Session& session, unsigned number, RenderOutputs& outputs);
  // Between two waves: contributes to saves and writes sums that are there. save: a signal has asked for one.
  void attend(const Session& session, bool save, RenderOutputs& outputs);
  // At the end, after the checkpoint: the whole render, in the process that writes it.
  std::optional<Rendered> whole(const Session& session, RenderOutputs& outputs);
  // After a SharedFailure.
  void finish();
  // At the very end, with the exit codes of all: that of all processes.
  int leave(int exitCode);

  // Without --checkpoint: saves the share, once, before a sum that may fail. `leave` removes it.
  void saveShare(const Session& session, RenderOutputs& outputs);
  // The file of that; empty with --checkpoint.
  const std::string& emergencyFile() const { return emergencyFile_; }

 private:
  Rendered rendered(RankSum sum) const;
  void write(RankSum sum, RenderOutputs& outputs);
  std::string fileOfShare(const std::string& file) const;

  std::optional<Ranks> ranks_;
  std::vector<std::string> places_;     // of all processes (placeOfThisProcess)
  std::vector<uint32_t> threadsOfAll_;  // from cutAlike on
  std::string emergencyFile_;
  std::optional<bool> shareSaved_;  // once this process has tried: whether it is in emergencyFile_
  uint32_t threads_ = 0;
  FilmArea area_;
};

}  // namespace wavecrest
