// Sessions that are rendered to their end, and how far their images lie apart.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>
#include <vector>

#include "engine/session/session.h"

namespace wavecrest {

inline std::unique_ptr<Session> renderedSession(const Scene& scene, const RenderSettings& settings) {
  auto session = Session::create(scene, settings);
  session->renderUntil(settings.iterations, std::nullopt);
  return session;
}

// Floats between both, at most over all samples.
inline int64_t worstDistance(const std::vector<float>& a, const std::vector<float>& b) {
  EXPECT_EQ(a.size(), b.size());
  int64_t worst = 0;
  for (size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    worst = std::max<int64_t>(worst, std::abs(int64_t{std::bit_cast<int32_t>(a[i])} - std::bit_cast<int32_t>(b[i])));
  }
  return worst;
}

}  // namespace wavecrest
