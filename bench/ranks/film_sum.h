// The sum of what several processes have rendered of one image: films, counts and times.
//
// A contribution is the work of one process, or of several summed up, as bytes that travel. The sum has a film of its
// own, which is made once.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "engine/session/session.h"
#include "engine/session/work_done.h"

namespace wavecrest {

// One process' part in a sum.
struct ProcessRecord {
  uint32_t rank = 0, threads = 0;
  uint64_t paths = 0, lightPaths = 0;
  double renderSeconds = 0, renderWallSeconds = 0, cpuSeconds = 0;
  uint64_t contributions = 0;      // before this one: snapshots and saves
  double contributingSeconds = 0;  // that rendering stood still for them
  double addingSeconds = 0;        // that sums have taken beside rendering
  char host[64] = {};              // ends with a zero

  nlohmann::ordered_json toJson() const;
};
// The record of this process.
ProcessRecord recordOf(uint32_t rank, uint32_t threads, const RenderStatistics& statistics);

// What a session has rendered so far, as a contribution behind so many bytes that the caller fills. No renderUntil may
// be running.
std::vector<unsigned char> contributionOf(const Session& session, const ProcessRecord& record, size_t head = 0);

// Bytes that a sum takes in any of so many processes at most: its own contribution, one of each child in the tree
// (sum_tree.h), the film of the sum, and behind the first process the sum as it is sent on. The same for all, as the
// number of light paths may follow from the memory that is left.
uint64_t bytesOfSums(const Scene& scene, const RenderSettings& settings, uint32_t ranks);

class FilmSum {
 public:
  using Bytes = std::span<const unsigned char>;
  // Adds all contributions, in their order, and calls added() after each. Throws StateError where one is of another
  // render. What the sum held before is gone.
  void sumUp(const std::vector<Bytes>& contributions, const std::function<void()>& added = nullptr);
  // The sum as a contribution behind so many bytes.
  std::vector<unsigned char> contribution(size_t head = 0) const;

  const Film& film() const { return *film_; }
  const std::vector<ProcessRecord>& processes() const { return processes_; }  // by rank
  // The statistics of all processes together. own: of this one, for what all have in common. Times are those of the
  // slowest process, CPU times add up.
  RenderStatistics statistics(RenderStatistics own) const;

 private:
  void add(Bytes contribution, bool first);

  std::unique_ptr<Film> film_;
  WorkDone work_;
  std::vector<ProcessRecord> processes_;
  ChainStatistics chains_;  // of mlt: counts, large steps, stuck chains; not what all processes have in common
};

}  // namespace wavecrest
