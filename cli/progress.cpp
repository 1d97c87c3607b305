#include "cli/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "bench/json_text.h"
#include "cli/messages.h"

namespace wavecrest {
namespace {

// automatic becomes a bar on a terminal and none elsewhere; other kinds stay.
ProgressKind resolved(ProgressKind kind) {
  if (kind != ProgressKind::automatic) return kind;
  return isatty(STDERR_FILENO) != 0 ? ProgressKind::bar : ProgressKind::none;
}

// What was noted, from any thread.
struct NoteList {
  std::mutex mutex;
  std::vector<std::string> notes;
  std::set<std::string> known;
};
NoteList& noteList() {
  static NoteList list;
  return list;
}

void keepNote(const std::string& text) {
  NoteList& list = noteList();
  const std::lock_guard<std::mutex> lock(list.mutex);
  if (list.known.insert(text).second) list.notes.push_back(text);
}

// The kind of progress by which notes are said where there is no progress.
ProgressKind told(ProgressKind kind) {
  return showsProgress(kind) || kind == ProgressKind::silent ? kind : ProgressKind::automatic;
}

// Time between two updates. Columns of the longest bar, and of the text beside it.
constexpr auto kInterval = std::chrono::milliseconds(250);
constexpr size_t kWidestBar = 40, kTextWidth = 40;

// Columns of the bar for which its line fits the terminal. 0: there is no room for a bar.
size_t barWidth() {
  winsize size{};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return kWidestBar;
  return size.ws_col > kTextWidth ? std::min<size_t>(kWidestBar, size.ws_col - kTextWidth) : 0;
}

}  // namespace

void noteLine(ProgressKind kind, const nlohmann::ordered_json& line, const std::string& text) {
  if (!showsProgress(kind)) return;
  writeStderr(kind == ProgressKind::jsonl ? jsonText(line) + "\n" : "wavecrest: " + text + "\n");
}

void note(ProgressKind kind, const std::string& text) {
  keepNote(text);
  if (kind != ProgressKind::quiet) noteLine(told(kind), {{"note", text}}, "note: " + text);
}

void warn(ProgressKind kind, const std::string& text) {
  keepNote(text);
  noteLine(told(kind), {{"warning", text}}, "warning: " + text);
}

std::string messageLine(ProgressKind kind, const std::string& text, std::string_view prefix) {
  if (kind == ProgressKind::jsonl) return jsonText(nlohmann::ordered_json{{"message", text}});
  return std::string(prefix) + text;
}

void tellMessage(ProgressKind kind, const std::string& text, std::string_view prefix) {
  tell("{}", messageLine(kind, text, prefix));
}

void tellFailedCheck(ProgressKind kind, const std::string& text) {
  if (kind == ProgressKind::jsonl) return tell("{}", jsonText(nlohmann::ordered_json{{"check_failed", text}}));
  tell("wavecrest: check failed: {}", text);
}

std::vector<std::string> notesSoFar() {
  NoteList& list = noteList();
  const std::lock_guard<std::mutex> lock(list.mutex);
  return list.notes;
}

Progress::Progress(ProgressKind kind, const Session& session, std::optional<double> seconds,
                   std::optional<uint64_t> paths, std::function<uint64_t()> elsewhere)
    : kind_(resolved(kind)), session_(session), seconds_(seconds), paths_(paths), elsewhere_(std::move(elsewhere)) {
  if (!showsProgress(kind_)) return;
  thread_ = std::thread([this] {
    // Sleeps in short steps, so that the destructor does not wait for a whole interval.
    while (!done_.load()) {
      show(false);
      for (int tick = 0; tick < 10 && !done_.load(); ++tick) std::this_thread::sleep_for(kInterval / 10);
    }
    show(true);
  });
}

Progress::~Progress() {
  done_.store(true);
  if (thread_.joinable()) thread_.join();
}

void Progress::show(bool last) const {
  // The larger fraction counts, because the render ends at the first goal that it reaches.
  const double now = session_.progressSeconds();
  const uint64_t paths = session_.progressPaths() + (elsewhere_ ? elsewhere_() : 0);
  double fraction = 0;
  if (seconds_) fraction = std::max(fraction, now / *seconds_);
  if (paths_) fraction = std::max(fraction, static_cast<double>(paths) / static_cast<double>(*paths_));
  fraction = std::min(fraction, 1.0);
  // JSON: one line for each update.
  if (kind_ == ProgressKind::jsonl) {
    tell(R"({{"fraction":{:.4f},"render_seconds":{:.3f},"paths":{}}})", fraction, now, paths);
    return;
  }
  // Bar: the line overwrites itself.
  const size_t width = barWidth();
  const auto filled = static_cast<size_t>(fraction * static_cast<double>(width));
  const std::string bar = width == 0 ? "" : "[" + std::string(filled, '=') + std::string(width - filled, ' ') + "] ";
  const double rate = now > 0 ? static_cast<double>(paths) / now * 1e-6 : 0;
  writeStderr(
      fmt::format("\r{}{:5.1f} % {:7.1f} s {:6.2f} M paths/s {}", bar, fraction * 100, now, rate, last ? "\n" : ""));
}

WritingProgress::WritingProgress(ProgressKind kind, std::string file)
    : kind_(resolved(kind)),
      file_(std::move(file)),
      next_(std::chrono::steady_clock::now() + std::chrono::seconds(1)) {}

WritingProgress::~WritingProgress() {
  if (shown_ && kind_ == ProgressKind::bar) writeStderr("\n");
}

void WritingProgress::show(double fraction) {
  const auto now = std::chrono::steady_clock::now();
  // Skips updates that come too early. The last update of a file that was shown before is never skipped.
  if (!showsProgress(kind_) || (now < next_ && !(shown_ && fraction >= 1))) return;
  next_ = now + kInterval;
  shown_ = true;
  if (kind_ == ProgressKind::jsonl) {
    tell("{}", jsonText(nlohmann::ordered_json{{"writing", file_}, {"fraction", fraction}}));
  } else {
    writeStderr(fmt::format("\rwriting {} {:5.1f} % ", file_, fraction * 100));
  }
}

}  // namespace wavecrest
