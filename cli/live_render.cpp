#include "cli/live_render.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "bench/live/live_server.h"
#include "bench/live/render_view.h"
#include "bench/live/tev_viewer.h"
#include "bench/live/watched_session.h"
#include "cli/commands.h"

namespace wavecrest {
namespace {

// What is wrong with an address; empty if nothing is. leastPort: 0 where the system may choose a port, else 1.
std::string checkAddress(const std::string& word, int leastPort) {
  const std::optional<HostPort> address = parseHostPort(word);
  if (address && address->port >= leastPort) return {};
  return fmt::format("'{}' is no address; expected PORT or HOST:PORT", word);
}

// The name of the image in tev. It tells methods and seeds apart, so tev shows their images side by side.
std::string nameInTev(const Scene& scene, const RenderSettings& settings) {
  return fmt::format("{} {} seed {}", scene.name, toString(settings.method), settings.seed);
}

// Starts the server of --view. The facts are shown on the page.
std::unique_ptr<RenderView> openPage(const HostPort& address, const Scene& scene, const RenderSettings& settings,
                                     const FilmArea& film) {
  const nlohmann::ordered_json facts = {{"scene", scene.name},
                                        {"method", toString(settings.method)},
                                        {"size", fmt::format("{} × {}", film.width, film.height)},
                                        {"seed", std::to_string(settings.seed)},
                                        {"threads", std::to_string(settings.threads)}};
  try {
    return std::make_unique<RenderView>(
        address, facts,
        RenderView::Goal{.seconds = settings.seconds.value_or(0), .iterations = settings.iterations.value_or(0)});
  } catch (const std::runtime_error& error) {
    throw UsageError(fmt::format("--view {}", error.what()));
  }
}

}  // namespace

void addViewOption(const Command& command, std::string& view) {
  command.add("--view", view, "serve a page that shows it under way, at PORT or HOST:PORT; port 0: any that is free")
      .valueOr(kPageAddress)
      .checkedBy([](const std::string& word) { return checkAddress(word, 0); });
}

// tev listens at its address, so the port cannot be 0 there.
void addLiveOptions(const Command& command, LiveOptions& options) {
  command.add("--tev", options.tev, "show the image under way in the viewer tev, which listens at HOST:PORT")
      .valueOr(kTevAddress)
      .checkedBy([](const std::string& word) { return checkAddress(word, 1); });
  addViewOption(command, options.view);
}

void tellPage(ProgressKind kind, const std::string& url) {
  // Without the address nobody could open the page, so it is shown even where progress is off.
  noteLine(showsProgress(kind) ? kind : ProgressKind::automatic, {{"view", url}}, "view: " + url);
}

LiveRender::LiveRender(const LiveOptions& options, const Scene& scene, const RenderSettings& settings,
                       ProgressKind kind, std::unique_ptr<Session>& session) {
  // Starts what was asked for: page, viewer or both.
  if (!options.view.empty()) {
    view_ = openPage(*parseHostPort(options.view), scene, settings, session->film().area());
    tellPage(kind, view_->url());
  }
  if (!options.tev.empty()) {
    tev_ = std::make_unique<TevViewer>(*parseHostPort(options.tev), nameInTev(scene, settings),
                                       [kind](const std::string& text) { warn(kind, text); });
  }
  // Without page and viewer the session stays as it is.
  if (!view_ && !tev_) return;
  // The session is replaced by one that takes looks and hands each to page and viewer.
  auto looked =
      std::make_unique<WatchedSession>(std::move(session), settings, [this](const std::shared_ptr<const Look>& look) {
        if (view_) view_->take(look);
        if (tev_) tev_->take(look);
      });
  watched_ = looked.get();
  session = std::move(looked);
}

// Here, because only this file knows the complete types of viewer and page.
LiveRender::~LiveRender() = default;

Session& LiveRender::interruptible(Session& session) const {
  return watched_ != nullptr ? watched_->within() : session;
}

void LiveRender::look(bool last) {
  if (watched_ != nullptr) watched_->look(last);
}

void LiveRender::showFile(const std::string& file) {
  if (tev_) tev_->showFile(file);
}

}  // namespace wavecrest
