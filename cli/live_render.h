// `render --tev [HOST:PORT]` and `--view [PORT]`: shows a render while it goes on.
#pragma once

#include <memory>
#include <string>

#include "bench/live/look.h"
#include "cli/command_line.h"
#include "cli/progress.h"
#include "engine/scene/scene.h"
#include "engine/session/session.h"

namespace wavecrest {

class RenderView;
class TevViewer;
class WatchedSession;

struct LiveOptions {
  std::string tev, view;  // empty: not asked for
};

void addLiveOptions(const Command& command, LiveOptions& options);
// --view alone, as other commands have it too.
void addViewOption(const Command& command, std::string& view);
// Where a page is, on stderr whatever the kind of progress.
void tellPage(ProgressKind kind, const std::string& url);

class LiveRender {
 public:
  // The session as it is, or one that is looked at where something is to be shown. Throws UsageError where the page's
  // address cannot be listened at.
  LiveRender(const LiveOptions& options, const Scene& scene, const RenderSettings& settings, ProgressKind kind,
             std::unique_ptr<Session>& session);
  // Takes leave of viewers.
  ~LiveRender();
  LiveRender(const LiveRender&) = delete;
  LiveRender& operator=(const LiveRender&) = delete;

  // Which session is to be interrupted: the one that renders.
  Session& interruptible(Session& session) const;
  // Shows what there is now.
  void look(bool last);
  // The image has been written to a file.
  void showFile(const std::string& file);

 private:
  std::unique_ptr<TevViewer> tev_;
  std::unique_ptr<RenderView> view_;
  WatchedSession* watched_ = nullptr;
};

}  // namespace wavecrest
