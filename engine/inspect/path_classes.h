// Path classes: which kinds of light paths a scene has, which of them each method can make, and by which method its
// reference should be rendered (METHODS.md section 8; Veach 1997, chapter 8, for the notation).
//
// A path is a light, events and the eye. Events with delta lobes are S, others D. Whether a strategy can make a path
// depends only on the light's kind and on where D stands, so paths with the same answers form a class. Classes are
// listed for the links that exist in the scene (engine/inspect/scene_links.h), each under its shortest path. Those
// whose shortest path is longer than the scene's paths may be are left out.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "engine/inspect/scene_links.h"
#include "engine/methods/method_list.h"

namespace wavecrest {

enum class Verdict { sampled, inefficient, impossible };
constexpr std::array<std::string_view, 3> kVerdictNames{"sampled", "inefficient", "impossible"};

// The bits of METHODS 8.1.
struct PathBits {
  bool deltaLight = false;  // point, spot or directional: no ray meets it
  bool firstD = false;      // the event next to the light is D
  bool lastD = false;       // the event next to the eye is D
  bool hasDD = false;       // two D are neighbours
  bool hasD = false;
  bool operator==(const PathBits&) const = default;
};

struct PathClass {
  std::string signature;    // "A S+ D E": A extended light, P delta light, S+ one or more; D D stands for two or more
  std::string description;  // in words
  PathBits bits;
  std::vector<Verdict> verdicts;  // in the order of kMethods
};

struct ReferenceChoice {
  Method method = Method::pt;
  bool biased = false;  // merging alone makes some class: the radius has to be tiny
  std::string reason;
};

struct PathClassTable {
  std::vector<PathClass> classes;
  ReferenceChoice reference;

  // Verdict of a method on a class.
  Verdict verdict(const PathClass& pathClass, Method method) const;
};

// The table of a scene with these links, whose paths have at most so many edges.
PathClassTable classifyPaths(const SceneLinks& links, uint32_t mostEdges = std::numeric_limits<uint32_t>::max());

// The table of a scene with the `max_depth` of its file. Throws std::runtime_error where the scene cannot be rendered.
PathClassTable classifyPaths(const Scene& scene);

}  // namespace wavecrest
