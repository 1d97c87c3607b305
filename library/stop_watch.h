// What a StopRequest stops.
#pragma once

#include "engine/session/session.h"
#include "wavecrest/campaign.h"

namespace wavecrest::api {

struct StopWatch {
  // The session that is to stop, or null while none renders. Once it returns no request holds the former session.
  static void watch(StopRequest& stop, Session* session) noexcept;
};

}  // namespace wavecrest::api
