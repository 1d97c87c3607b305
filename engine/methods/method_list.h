// The list of light-transport methods: the name that --method takes, and the pipeline.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "engine/pipeline.h"

namespace wavecrest {

enum class Method { pt, lt, bpt, mlt, ppm, bpm, vcm };

// What the chains of Metropolis light transport walk in: primary samples of path tracing, primary samples of
// bidirectional path tracing with one strategy per path, or paths.
enum class MetropolisVariant { pssmlt, mmlt, pathspace };
constexpr std::array<std::string_view, 3> kMetropolisVariantNames{"pssmlt", "mmlt", "pathspace"};

// The ways in which a method joins s light vertices and t camera vertices. engine/path_classes.h derives from them
// which paths the method can make.
struct PathStrategies {
  bool emission = false;            // s = 0: a camera path meets a light
  bool nextEvent = false;           // s = 1
  bool connect = false;             // s >= 2, t >= 2
  bool camera = false;              // t = 1
  bool merge = false;               // without nextEvent, emission then serves the paths that have no vertex to merge at
  bool specularViewsOnly = false;   // emission and nextEvent serve only what a delta lobe, or nothing, shows to the eye
  bool mergeAtFirstVertex = false;  // merges where a camera path first has more than delta lobes, and nowhere else
  bool operator==(const PathStrategies&) const = default;
};

struct MethodEntry {
  Method method;
  std::string_view name;         // spelling of --method
  std::string_view description;  // one line
  bool bidirectional;            // needs kernels with the whole MIS recursion
  PathStrategies strategies;
};

constexpr std::array kMethods{
    MethodEntry{
        Method::pt, "pt", "path tracing with next event estimation", false, {.emission = true, .nextEvent = true}},
    MethodEntry{Method::lt,
                "lt",
                "light tracing, and path tracing of directly visible specular surfaces",
                true,
                {.emission = true, .nextEvent = true, .camera = true, .specularViewsOnly = true}},
    MethodEntry{Method::bpt,
                "bpt",
                "bidirectional path tracing",
                true,
                {.emission = true, .nextEvent = true, .connect = true, .camera = true}},
    // As mmlt and pathspace; pssmlt makes what pt does.
    MethodEntry{Method::mlt,
                "mlt",
                "Metropolis light transport",
                true,
                {.emission = true, .nextEvent = true, .connect = true, .camera = true}},
    MethodEntry{Method::ppm,
                "ppm",
                "progressive photon mapping",
                true,
                {.emission = true, .merge = true, .mergeAtFirstVertex = true}},
    MethodEntry{Method::bpm,
                "bpm",
                "bidirectional photon mapping: merging at every vertex",
                true,
                {.emission = true, .merge = true}},
    MethodEntry{Method::vcm,
                "vcm",
                "vertex connection and merging",
                true,
                {.emission = true, .nextEvent = true, .connect = true, .camera = true, .merge = true}},
};

constexpr std::optional<Method> parseMethod(std::string_view word) {
  for (const MethodEntry& entry : kMethods) {
    if (entry.name == word) return entry.method;
  }
  return std::nullopt;
}
constexpr const MethodEntry& entryOf(Method method) { return kMethods[static_cast<size_t>(method)]; }
constexpr std::string_view toString(Method method) { return entryOf(method).name; }

// "pt, lt, ...": what --method may be.
std::string methodChoices();

// Each method's pipeline, in a file of its own.
template <class S>
Pipeline<S> pathTracing(const Stages<S>& stages, const Intersector<S>& intersector);
template <class S>
Pipeline<S> lightTracing(const Stages<S>& stages, const Intersector<S>& intersector);
template <class S>
Pipeline<S> bidirectionalPathTracing(const Stages<S>& stages, const Intersector<S>& intersector);
template <class S>
Pipeline<S> progressivePhotonMapping(const Stages<S>& stages, const Intersector<S>& intersector);
template <class S>
Pipeline<S> bidirectionalPhotonMapping(const Stages<S>& stages, const Intersector<S>& intersector);
template <class S>
Pipeline<S> vertexConnectionAndMerging(const Stages<S>& stages, const Intersector<S>& intersector);

template <class S>
Pipeline<S> primarySampleSpace(const Stages<S>& stages, const Intersector<S>& intersector);
template <class S>
Pipeline<S> multiplexedMetropolis(const Stages<S>& stages, const Intersector<S>& intersector);
template <class S>
Pipeline<S> pathSpaceMetropolis(const Stages<S>& stages, const Intersector<S>& intersector);

// variant: of mlt.
template <class S>
Pipeline<S> makePipeline(Method method, MetropolisVariant variant, const Stages<S>& stages,
                         const Intersector<S>& intersector);

}  // namespace wavecrest
