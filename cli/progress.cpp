#include "cli/progress.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <string>

namespace wavecrest {
namespace {

ProgressKind resolved(ProgressKind kind) {
  if (kind != ProgressKind::automatic) return kind;
  return isatty(STDERR_FILENO) != 0 ? ProgressKind::bar : ProgressKind::none;
}

constexpr auto kInterval = std::chrono::milliseconds(250);
constexpr size_t kBarWidth = 40;

}  // namespace

Progress::Progress(ProgressKind kind, const Session& session, std::optional<double> seconds,
                   std::optional<uint64_t> paths)
    : kind_(resolved(kind)), session_(session), seconds_(seconds), paths_(paths) {
  if (kind_ == ProgressKind::none) return;
  thread_ = std::thread([this] {
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
  const double now = session_.progressSeconds();
  const uint64_t paths = session_.progressPaths();
  double fraction = 0;
  if (seconds_) fraction = std::max(fraction, now / *seconds_);
  if (paths_) fraction = std::max(fraction, static_cast<double>(paths) / static_cast<double>(*paths_));
  fraction = std::min(fraction, 1.0);
  if (kind_ == ProgressKind::jsonl) {
    fmt::print(stderr, "{{\"fraction\":{:.4f},\"render_seconds\":{:.3f},\"paths\":{}}}\n", fraction, now, paths);
    return;
  }
  const auto filled = static_cast<size_t>(fraction * kBarWidth);
  const double rate = now > 0 ? static_cast<double>(paths) / now * 1e-6 : 0;
  fmt::print(stderr, "\r[{}{}] {:5.1f} %  {:7.1f} s  {:6.2f} M paths/s {}", std::string(filled, '='),
             std::string(kBarWidth - filled, ' '), fraction * 100, now, rate, last ? "\n" : "");
  std::fflush(stderr);
}

}  // namespace wavecrest
