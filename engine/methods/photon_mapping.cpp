// Photon mapping with a radius that shrinks over the iterations (Knaus and Zwicker 2011): merging stands alone.
#include "engine/methods/method_list.h"

namespace wavecrest {
namespace {

WalkPhase photons() {
  using enum StageId;
  return walk(Walk::light, generateLightPaths, {extend, arrive, storeLightVertices, scatter});
}

}  // namespace

// ppm: a camera path merges at its first vertex with more than delta lobes and goes on by delta lobes only, so each
// path is made once and needs no weight (Hachisuka and Jensen 2009).
MethodPage progressivePhotonMapping() {
  using enum StageId;
  return {
      {photons(), buildPhotonMap(), walk(Walk::camera, generateCameraPaths, {extend, arrive, merge, scatterSpecular})}};
}

// The same with direct light by next event estimation: photons are kept from their second vertex on, so that those
// which come straight from a light are not counted again.
MethodPage photonMappingWithDirectPass() {
  using enum StageId;
  return {
      {walk(Walk::light, generateLightPaths, {extend, arrive, scatter}, {extend, arrive, storeLightVertices, scatter}),
       buildPhotonMap(),
       walk(Walk::camera, generateCameraPaths, {extend, arrive, nextEvent, occlude, merge, scatterSpecular})}};
}

// bpm: a camera path merges at every such vertex and goes on by all lobes; weights share each path among the vertices
// where it could have been merged (Vorba 2011).
MethodPage bidirectionalPhotonMapping() {
  using enum StageId;
  return {{photons(), buildPhotonMap(), walk(Walk::camera, generateCameraPaths, {extend, arrive, merge, scatter})}};
}

}  // namespace wavecrest
