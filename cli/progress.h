// Progress of a render on stderr, from a thread of its own that only reads counters, and other lines beside it.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "engine/session/session.h"

namespace wavecrest {

// quiet: --quiet, which leaves out notes as well. silent: says nothing, as another process says the same.
enum class ProgressKind { automatic, bar, jsonl, none, quiet, silent };
inline ProgressKind quietIf(bool quiet, ProgressKind kind) { return quiet ? ProgressKind::quiet : kind; }
inline bool showsProgress(ProgressKind kind) { return kind < ProgressKind::none; }
constexpr std::array<std::string_view, 4> kProgressNames{"auto", "bar", "jsonl", "none"};

// A line beside the progress: with jsonl an object {key: value}, else "wavecrest: TEXT".
void noteLine(ProgressKind kind, const nlohmann::ordered_json& line, const std::string& text);
// The same of a note, which says what was approximated, ignored or clamped: unless quiet, whatever the progress.
void note(ProgressKind kind, const std::string& text);
// The same of a warning, which is said in any case.
void warn(ProgressKind kind, const std::string& text);
// A line that is said in any case: with jsonl {"message": TEXT}, else PREFIX TEXT. messageLine: without its end.
std::string messageLine(ProgressKind kind, const std::string& text, std::string_view prefix = "wavecrest: ");
void tellMessage(ProgressKind kind, const std::string& text, std::string_view prefix = "wavecrest: ");
// A requested check that failed: with jsonl {"check_failed": TEXT}, else "wavecrest: check failed: TEXT".
void tellFailedCheck(ProgressKind kind, const std::string& text);
// All notes and warnings of this process so far, said or not, each once: for its statistics.
std::vector<std::string> notesSoFar();

class Progress {
 public:
  // automatic: a bar if stderr is a terminal, else nothing. The goal is what the render runs towards. elsewhere: paths
  // of other processes so far, from any thread; empty where there are none.
  Progress(ProgressKind kind, const Session& session, std::optional<double> seconds, std::optional<uint64_t> paths,
           std::function<uint64_t()> elsewhere = {});
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

 private:
  void show(bool last) const;

  const ProgressKind kind_;
  const Session& session_;
  const std::optional<double> seconds_;
  const std::optional<uint64_t> paths_;
  const std::function<uint64_t()> elsewhere_;
  std::atomic<bool> done_{false};
  std::thread thread_;
};

// Progress of a file that is being written; shown only once it has taken a second, and then every quarter.
class WritingProgress {
 public:
  WritingProgress(ProgressKind kind, std::string file);
  // Ends the line.
  ~WritingProgress();
  WritingProgress(const WritingProgress&) = delete;
  WritingProgress& operator=(const WritingProgress&) = delete;
  void show(double fraction);

 private:
  const ProgressKind kind_;
  const std::string file_;
  std::chrono::steady_clock::time_point next_;
  bool shown_ = false;
};

}  // namespace wavecrest
