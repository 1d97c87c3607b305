// The page of `render --view`: the image while it converges, its error and paths/s over time.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "bench/live/live_server.h"
#include "bench/live/look.h"

namespace wavecrest {

class RenderView {
 public:
  // facts: what the page says of the render, as text by label; "scene" and "method" are its title. goal: render seconds
  // and iterations, 0 for none, that make the page's progress.
  struct Goal {
    double seconds = 0;
    uint64_t iterations = 0;
  };
  RenderView(const HostPort& address, const nlohmann::ordered_json& facts, const Goal& goal);

  const std::string& url() const { return server_.url(); }
  void take(const std::shared_ptr<const Look>& look);

 private:
  const Goal goal_;
  LiveServer server_;
  uint64_t paths_ = 0;  // as of the last look
  double seconds_ = 0;
};

}  // namespace wavecrest
