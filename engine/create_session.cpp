#include <utility>

#include "engine/chains/chain_session.h"
#include "engine/session/session.h"
#include "engine/trials/choose_method.h"
#include "engine/waves/wave_session.h"

namespace wavecrest {
namespace {

template <class S>
std::unique_ptr<Session> makeSession(const Scene& scene, const RenderSettings& settings) {
  if (settings.method == Method::mlt) return makeChainSession<S>(scene, settings);
  if (!areTried(settings)) return makeWaveSession<S>(scene, settings);
  Prepared<S> prepared = chooseMethod<S>(scene, settings);
  const RenderSettings chosen = withMethod(settings, prepared.choice->method);
  return makeWaveSession<S>(scene, chosen, std::move(prepared));
}

}  // namespace

std::unique_ptr<Session> Session::create(const Scene& scene, const RenderSettings& asked) {
  const RenderSettings settings = withinDepthOfMethod(asked);
  return settings.precision == Precision::doubled ? makeSession<double>(scene, settings)
                                                  : makeSession<float>(scene, settings);
}

}  // namespace wavecrest
