// A session that can be interrupted, and nothing else.
#pragma once

#include <stdexcept>

#include "engine/session/session.h"

namespace wavecrest {

class IdleSession : public Session {
 public:
  void renderUntil(std::optional<uint64_t>, std::optional<double>) override {}
  RenderStatistics statistics() const override { return {}; }
  const Film& film() const override { throw std::logic_error("no film"); }
  const MemoryPlan& memoryPlan() const override { throw std::logic_error("no plan"); }
  void save(StateWriter&) const override {}
  void restore(StateReader&) override {}
  double progressSeconds() const override { return 0; }
  uint64_t progressPaths() const override { return 0; }
};

}  // namespace wavecrest
