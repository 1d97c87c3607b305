// The list of light-transport methods: the name that --method takes, and the page.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "engine/methods/method_page.h"

namespace wavecrest {

enum class Method { pt, lt, bpt, mlt, ppm, bpm, vcm, gpt, evcm };

// What the chains of Metropolis light transport walk in: primary samples of path tracing, primary samples of
// bidirectional path tracing with one strategy per path, or paths.
enum class MetropolisVariant { pssmlt, mmlt, pathspace };
constexpr std::array<std::string_view, 3> kMetropolisVariantNames{"pssmlt", "mmlt", "pathspace"};

// The page of each method, in a file of its own.
MethodPage pathTracing();
MethodPage lightTracing();
MethodPage bidirectionalPathTracing();
MethodPage primarySampleSpace();
MethodPage multiplexedMetropolis();
MethodPage pathSpaceMetropolis();
MethodPage progressivePhotonMapping();
MethodPage photonMappingWithDirectPass();
MethodPage bidirectionalPhotonMapping();
MethodPage vertexConnectionAndMerging();
MethodPage guidedPathTracing();

struct MethodEntry {
  Method method;
  std::string_view name;         // spelling of --method
  std::string_view description;  // one line
  MethodPage (*page)();          // of mlt: of its default variant; of evcm: with all that it may choose
};

// In the order of the enumeration.
constexpr std::array kMethods{
    MethodEntry{Method::pt, "pt", "path tracing with next event estimation", pathTracing},
    MethodEntry{Method::lt, "lt", "light tracing, and path tracing of directly visible specular surfaces",
                lightTracing},
    MethodEntry{Method::bpt, "bpt", "bidirectional path tracing", bidirectionalPathTracing},
    MethodEntry{Method::mlt, "mlt", "Metropolis light transport", multiplexedMetropolis},
    MethodEntry{Method::ppm, "ppm", "progressive photon mapping", progressivePhotonMapping},
    MethodEntry{Method::bpm, "bpm", "bidirectional photon mapping: merging at every vertex",
                bidirectionalPhotonMapping},
    MethodEntry{Method::vcm, "vcm", "vertex connection and merging", vertexConnectionAndMerging},
    MethodEntry{Method::gpt, "gpt", "guided path tracing: learns where light comes from", guidedPathTracing},
    MethodEntry{Method::evcm, "evcm", "pt, lt, bpt or vcm, whichever suits the image: trials choose",
                vertexConnectionAndMerging},
};
static_assert([] {
  for (size_t i = 0; i < kMethods.size(); ++i) {
    if (kMethods[i].method != static_cast<Method>(i)) return false;
  }
  return true;
}());

constexpr const MethodEntry& entryOf(Method method) { return kMethods[static_cast<size_t>(method)]; }
constexpr std::string_view toString(Method method) { return entryOf(method).name; }

// Whether the method is another one of the list, chosen for the image (engine/trials/choose_method.h).
constexpr bool isChosenByTrials(Method method) { return method == Method::evcm; }

// "pt, lt, ...": what --method may be.
std::string methodChoices();

// variant: of mlt. directPass: of ppm.
MethodPage pageOf(Method method, MetropolisVariant variant, bool directPass = false);
inline PathStrategies strategiesOf(Method method) { return strategiesOf(entryOf(method).page()); }

}  // namespace wavecrest
