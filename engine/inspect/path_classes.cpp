#include "engine/inspect/path_classes.h"

#include <algorithm>
#include <stdexcept>

#include "engine/plan/render_settings.h"

namespace wavecrest {
namespace {

// ---- which classes there are ----------------------------------------------------------------------------------------

// A path from the light to its last event so far.
struct Prefix {
  PathBits bits;
  bool lastIsD = false, any = false;
  bool operator==(const Prefix&) const = default;
};

// The prefix with one more event.
Prefix extended(Prefix path, bool diffuse) {
  if (diffuse) {
    if (!path.any) path.bits.firstD = true;
    path.bits.hasDD |= path.any && path.lastIsD;
    path.bits.hasD = true;
  }
  path.any = true;
  path.lastIsD = diffuse;
  return path;
}

// All prefixes that the scene's links allow, breadth first.
std::vector<Prefix> reachablePrefixes(const SceneLinks& links, LightKindOfPath light) {
  std::vector<Prefix> found;
  const auto add = [&](const Prefix& path) {
    if (std::find(found.begin(), found.end(), path) == found.end()) found.push_back(path);
  };
  // The first event follows the light.
  Prefix start;
  start.bits.deltaLight = light == LightKindOfPath::delta;
  for (const EventKind event : {EventKind::diffuse, EventKind::specular}) {
    if (links.fromLight[static_cast<size_t>(light)][static_cast<size_t>(event)]) {
      add(extended(start, event == EventKind::diffuse));
    }
  }
  // Every later event follows one of its neighbours. There are few distinct prefixes, so the search ends.
  for (size_t i = 0; i < found.size(); ++i) {  // NOLINT(modernize-loop-convert): it grows
    const Prefix path = found[i];
    const auto last = static_cast<size_t>(path.lastIsD ? EventKind::diffuse : EventKind::specular);
    for (const EventKind event : {EventKind::diffuse, EventKind::specular}) {
      if (links.between[last][static_cast<size_t>(event)]) add(extended(path, event == EventKind::diffuse));
    }
  }
  return found;
}

// The shortest path of a class, as in PathClass::signature.
std::string signatureOf(const PathBits& bits) {
  std::string text = bits.deltaLight ? "P " : "A ";
  if (!bits.hasD) return text + "S+ E";
  if (!bits.firstD) text += "S+ ";
  text += bits.hasDD ? "D D " : "D ";
  if (!bits.lastD) text += "S+ ";
  return text + "E";
}

// Edges of the shortest path of a class.
uint32_t fewestEdges(const PathBits& bits) {
  if (!bits.hasD) return 2;
  return 2 + (bits.firstD ? 0u : 1u) + (bits.hasDD ? 1u : 0u) + (bits.lastD ? 0u : 1u);
}

// The class in words.
std::string describe(const PathBits& bits) {
  if (!bits.hasD) return "lights seen in specular surfaces";
  std::string text;
  if (bits.firstD) {
    text = bits.hasDD ? "indirect light" : "direct light";
  } else {
    text = bits.hasDD ? "indirect light of caustics" : "caustics";
  }
  if (!bits.lastD) text += " seen in specular surfaces";
  return text;
}

// The classes of the paths that the scene's links and its depth allow: a reachable prefix whose last event the eye
// sees.
std::vector<PathClass> findClasses(const SceneLinks& links, uint32_t mostEdges) {
  std::vector<PathClass> classes;
  if (links.eyeMeetsLight) classes.push_back({"A E", "lights in view", {}, {}});
  for (const LightKindOfPath light : {LightKindOfPath::extended, LightKindOfPath::delta}) {
    std::vector<PathBits> seen;
    for (const Prefix& path : reachablePrefixes(links, light)) {
      const auto last = static_cast<size_t>(path.lastIsD ? EventKind::diffuse : EventKind::specular);
      if (!links.fromEye[last]) continue;
      PathBits bits = path.bits;
      bits.lastD = path.lastIsD;
      // From a delta light over delta lobes alone nothing reaches an image, by any method.
      if (bits.deltaLight && !bits.hasD) continue;
      if (fewestEdges(bits) > mostEdges) continue;
      if (std::find(seen.begin(), seen.end(), bits) == seen.end()) seen.push_back(bits);
    }
    // Plain ones first: without specular events, then with more and more of them.
    const auto order = [](const PathBits& b) { return std::array{!b.firstD + !b.lastD, !b.firstD + 0, b.hasDD + 0}; };
    std::sort(seen.begin(), seen.end(), [&](const PathBits& a, const PathBits& b) { return order(a) < order(b); });
    for (const PathBits& bits : seen) classes.push_back({signatureOf(bits), describe(bits), bits, {}});
  }
  return classes;
}

// ---- which method makes which ---------------------------------------------------------------------------------------

// From these figures on a strategy is efficient. The study turned from pt to bpt where lamps filled 0.06 sr of what a
// typical vertex sees, so its references are reproduced with 0.1.
constexpr double kLightSolidAngle = 0.1;  // sr: s = 0 behind a diffuse event
constexpr double kCameraCoverage = 0.01;  // share of light vertices that the lens sees: t = 1
constexpr double kLightCoverage = 0.1;    // share of camera vertices that see a light: s = 1 on indirect light

struct Judge {
  const SceneLinks& links;

  // The best that any of the method's strategies makes of the class.
  Verdict verdict(const PathStrategies& method, const PathBits& path) const {
    Verdict best = Verdict::impossible;
    const auto offer = [&](bool makes, bool efficient) {
      if (makes) best = std::min(best, efficient ? Verdict::sampled : Verdict::inefficient);
    };
    // With specularViewsOnly, only t = 1 makes paths whose last event is D.
    const bool inView = !method.specularViewsOnly || !path.lastD;
    // Emission beside merging without next event estimation makes only paths without D.
    const bool mergingAlone = method.merge && !method.nextEvent;
    offer(method.emission && inView && !path.deltaLight && !(mergingAlone && path.hasD), emissionIsEfficient(path));
    // Next event estimation is efficient for direct light. For indirect light enough camera vertices have to see a
    // light.
    offer(method.nextEvent && inView && path.firstD, !path.hasDD || links.lightCoverage >= kLightCoverage);
    // Connections are inefficient where all pairs of D are glossy.
    offer(method.connect && path.hasDD, !links.onlyGlossyPairs);
    // A glossy surface in view makes t = 1 inefficient, and merging if it is at the first vertex alone.
    offer(method.camera && path.lastD, links.cameraCoverage >= kCameraCoverage && !links.eyeSeesGlossy);
    offer(method.merge && path.hasD, !(method.mergeAtFirstVertex && path.lastD && links.eyeSeesGlossy));
    return best;
  }

  // A light behind delta lobes alone is met for certain; behind a diffuse event, by chance.
  bool emissionIsEfficient(const PathBits& path) const {
    return !path.hasD || links.lightSolidAngle >= kLightSolidAngle;
  }
};

// ---- the reference --------------------------------------------------------------------------------------------------

struct Count {
  size_t inefficient = 0, impossible = 0;
  std::string names;  // of the first classes that are not sampled
};

// How many classes a method makes inefficiently or not at all, with the names of two of them.
Count countFor(const PathClassTable& table, Method method) {
  Count count;
  size_t named = 0;
  for (const PathClass& pathClass : table.classes) {
    const Verdict verdict = table.verdict(pathClass, method);
    count.inefficient += verdict == Verdict::inefficient ? 1 : 0;
    count.impossible += verdict == Verdict::impossible ? 1 : 0;
    if (verdict == Verdict::sampled || ++named > 2) continue;
    count.names += (count.names.empty() ? "" : ", ") + pathClass.signature;
  }
  if (named > 2) count.names += ", ...";
  return count;
}

// The classes that a method cannot make.
std::string impossibleFor(const PathClassTable& table, Method method) {
  std::string names;
  for (const PathClass& pathClass : table.classes) {
    if (table.verdict(pathClass, method) != Verdict::impossible) continue;
    names += (names.empty() ? "" : ", ") + pathClass.signature;
  }
  return names;
}

// METHODS 8.3, which is the study's rule, with one line more: light tracing where it makes every class well and path
// tracing does not, because no connection is then worth its price.
ReferenceChoice chooseReference(const PathClassTable& table) {
  // An unbiased method: pt, then lt, then bpt, then pt although it is inefficient.
  const Count pt = countFor(table, Method::pt);
  if (pt.impossible + pt.inefficient == 0) return {Method::pt, false, "path tracing samples every class of paths"};
  if (pt.impossible != 0) {
    const Count lt = countFor(table, Method::lt);
    if (lt.impossible + lt.inefficient == 0) {
      return {Method::lt, false,
              "path tracing cannot make " + pt.names + "; light tracing samples every class without connections"};
    }
  }
  const Count bpt = countFor(table, Method::bpt);
  if (bpt.impossible == 0 && (pt.impossible != 0 || bpt.inefficient < pt.inefficient)) {
    return {Method::bpt, false,
            "path tracing " + std::string(pt.impossible != 0 ? "cannot make " : "is inefficient for ") + pt.names +
                "; bidirectional path tracing is unbiased and samples " +
                (bpt.inefficient == 0 ? "every class" : "all classes, few of them inefficiently")};
  }
  if (pt.impossible == 0) {
    return {Method::pt, false, "path tracing makes every class of paths, " + pt.names + " inefficiently"};
  }
  // Merging, which is biased.
  for (const Method method : {Method::vcm, Method::ppm}) {
    if (countFor(table, method).impossible != 0) continue;
    return {method, true,
            "no unbiased method makes every class (bpt lacks " + impossibleFor(table, Method::bpt) +
                "); a tiny radius keeps the bias of merging small"};
  }
  throw std::invalid_argument("chooseReference: none of the methods makes every class");
}

}  // namespace

Verdict PathClassTable::verdict(const PathClass& pathClass, Method method) const {
  return pathClass.verdicts[static_cast<size_t>(method)];
}

PathClassTable classifyPaths(const SceneLinks& links, uint32_t mostEdges) {
  PathClassTable table;
  const Judge judge{links};
  table.classes = findClasses(links, mostEdges);
  for (PathClass& pathClass : table.classes) {
    for (const MethodEntry& entry : kMethods) {
      pathClass.verdicts.push_back(judge.verdict(strategiesOf(entry.method), pathClass.bits));
    }
  }
  table.reference = chooseReference(table);
  return table;
}

PathClassTable classifyPaths(const Scene& scene) {
  return classifyPaths(findLinks(scene), pathLimits(scene.defaults.maxDepth, scene.defaults.rrDepth).maxDepth);
}

}  // namespace wavecrest
