#include "engine/chains/chain_session.h"
#include "engine/session/session.h"
#include "engine/waves/wave_session.h"

namespace wavecrest {
namespace {

template <class S>
std::unique_ptr<Session> makeSession(const Scene& scene, const RenderSettings& settings) {
  return settings.method == Method::mlt ? makeChainSession<S>(scene, settings) : makeWaveSession<S>(scene, settings);
}

}  // namespace

std::unique_ptr<Session> Session::create(const Scene& scene, const RenderSettings& asked) {
  const RenderSettings settings = withinDepthOfMethod(asked);
  return settings.precision == Precision::doubled ? makeSession<double>(scene, settings)
                                                  : makeSession<float>(scene, settings);
}

}  // namespace wavecrest
