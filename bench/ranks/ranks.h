// The processes of one render that a launcher has started together, each with a share of the iterations.
//
// All processes do the same steps in the same order: agree, contribute to snapshots, contribute to the end, agree.
// Contributions are added up beside the rendering (mailbox.h, sum_tree.h); process 0 takes the sums and writes them.
// A signal that one process gets, the others hear of. A process that is silent for too long is lost: the others then
// stop and save their own shares, as they do after a signal; whatever still waits for the lost one throws.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "bench/ranks/film_sum.h"
#include "bench/ranks/launch.h"
#include "bench/ranks/mailbox.h"
#include "bench/ranks/mpi_library.h"
#include "bench/ranks/sum_tree.h"

namespace wavecrest {

// A sum of all processes.
struct RankSum {
  SumLabel label = 0;
  RenderStatistics statistics;
  std::vector<float> image;          // RGB, row by row
  nlohmann::ordered_json processes;  // ProcessRecord::toJson of each
};

// What the messages of other processes do to the render here. Called on another thread, but rescue.
struct RankHooks {
  std::function<bool()> interrupted;  // whether a signal has asked this process to stop
  std::function<bool()> saveWanted;   // whether one has asked it for a save since the last call
  std::function<void()> stop;         // another process has got one
  std::function<void()> attend;       // there is something to take: saves or sums
  std::function<uint64_t()> paths;    // so far, for progress
  // All are to stop while this process waits for others. Called once, on the thread that waits.
  std::function<void()> rescue;
};

class Ranks {
 public:
  // Starts MPI. Throws RanksError where that does not connect the processes of the launch.
  explicit Ranks(const Launch& launch);
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  uint32_t rank() const { return mailbox_->rank(); }
  uint32_t count() const { return mailbox_->ranks(); }
  bool first() const { return rank() == 0; }

  // Hands a text to all processes and returns those of all, by rank. Waits for all. Throws RanksError where one is
  // lost.
  std::vector<std::string> exchange(const std::string& text);
  // While the render goes on. Without hooks: none does.
  void watch(RankHooks hooks);

  // Contributes what the session has rendered. Of a snapshot: waits until this process is but a few ahead of the
  // slowest.
  void contribute(SumLabel label, const Session& session, uint32_t threads);
  // Asks all processes for a save; they contribute once they find its label in takeSaves.
  void requestSave();
  std::vector<SumLabel> takeSaves();
  // In process 0: the next sum in the order in which they were completed, if there is one; or waits for one.
  std::optional<RankSum> takeSum();
  RankSum waitForSum();
  // Paths of the other processes as they last said.
  uint64_t pathsElsewhere() const;

  // Leaves MPI together with all others. Not to be called after a loss.
  void finish();

 private:
  enum class Kind : uint64_t { text, texts, contribution, completed, wantSave, save, stop, lost, paths, alive };

  void received(uint32_t from, Mailbox::Bytes message);
  void tick();
  void sendNews();
  void failed(const std::exception& error);
  void send(uint32_t to, Kind kind, uint64_t number, std::span<const unsigned char> content = {});
  // message: begins with room for the head.
  void sendWithHead(uint32_t to, Kind kind, uint64_t number, Mailbox::Bytes message);
  void sendToOthers(Kind kind, uint64_t number);
  void takeText(uint32_t from, std::string text);
  void takeContribution(uint32_t from, SumLabel label, Mailbox::Bytes message, bool lastStands);
  void complete(SumLabel label, std::vector<Mailbox::Bytes> messages);
  void callStop();
  // Waits until ready() is true, with the mutex held, for as long as all processes live. Calls the hook `rescue` once
  // all are to stop. Throws RanksError where a process is lost, or a sum is broken.
  void wait(std::unique_lock<std::mutex>& lock, const std::function<bool()>& ready);

  std::unique_ptr<Mailbox> mailbox_;
  // Of the thread that contributes.
  uint64_t contributions_ = 0;
  double contributingSeconds_ = 0;
  std::atomic<double> addingSeconds_{0};
  // Of the mailbox' thread.
  std::optional<SumTree> tree_;
  FilmSum sum_;
  bool stopSaid_ = false, saveUnderWay_ = false;
  uint64_t saves_ = 0;
  std::chrono::steady_clock::time_point lastTick_{}, lastNews_{};
  std::vector<double> silence_;  // seconds without a message, by rank: all in process 0, elsewhere that of process 0
  // Guarded by the mutex.
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  RankHooks hooks_;
  std::vector<std::optional<std::string>> texts_;     // process 0: of this exchange
  std::optional<std::vector<std::string>> allTexts_;  // the answer
  std::map<SumLabel, RenderStatistics> own_;          // process 0: at its contributions
  std::vector<SumLabel> outstanding_, wantedSaves_;
  std::vector<RankSum> sums_;
  std::vector<uint64_t> paths_;
  bool stopping_ = false;
  std::optional<uint32_t> lost_;
  std::string broken_;  // what went wrong with a sum or a message
};

}  // namespace wavecrest
