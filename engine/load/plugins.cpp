#include "engine/load/plugins.h"

#include "engine/load/bsdfs.h"
#include "engine/load/emitters.h"
#include "engine/load/film.h"
#include "engine/load/mesh_attributes.h"
#include "engine/load/sensor.h"
#include "engine/load/shapes.h"
#include "engine/load/textures.h"

namespace wavecrest {

std::string outOfScope(const XmlElement& object) {
  // Plugins of Mitsuba that need something wavecrest lacks altogether, and the words for it.
  struct Subject {
    std::string_view tag, type, about;
  };
  constexpr Subject kSubjects[] = {{"bsdf", "hair", "hair"},
                                   {"bsdf", "measured", "measured BSDFs"},
                                   {"bsdf", "measured_polarized", "measured BSDFs and polarisation"},
                                   {"bsdf", "pplastic", "polarisation"},
                                   {"bsdf", "polarizer", "polarisation"},
                                   {"bsdf", "retarder", "polarisation"},
                                   {"bsdf", "circular", "polarisation"},
                                   {"shape", "bsplinecurve", "curves"},
                                   {"shape", "linearcurve", "curves"},
                                   {"shape", "hair", "hair"},
                                   {"shape", "sdfgrid", "signed distance fields"},
                                   {"shape", "ellipsoids", "volumes of ellipsoids"},
                                   {"shape", "ellipsoidsmesh", "volumes of ellipsoids"}};
  for (const Subject& subject : kSubjects) {
    if (object.tag != subject.tag || object.get("type") != subject.type) continue;
    return ", since wavecrest renders no " + std::string(subject.about);
  }
  return {};
}

// `phong`, `mixturebsdf`, `coating` and `roughcoating` are of Mitsuba 0.6.
std::span<const BsdfPlugin> bsdfPlugins() {
  static constexpr BsdfPlugin kPlugins[] = {{"diffuse", &readDiffuse},
                                            {"conductor", &readConductor},
                                            {"roughconductor", &readRoughConductor},
                                            {"dielectric", &readDielectric},
                                            {"thindielectric", &readThinDielectric},
                                            {"roughdielectric", &readRoughDielectric},
                                            {"plastic", &readPlastic},
                                            {"roughplastic", &readRoughPlastic},
                                            {"phong", &readPhong},
                                            {"principled", &readPrincipled},
                                            {"principledthin", &readPrincipledThin},
                                            {"blendbsdf", &readBlend},
                                            {"mixturebsdf", &readMixture},
                                            {"coating", &readCoating},
                                            {"roughcoating", &readRoughCoating},
                                            {"twosided", &readTwoSided},
                                            {"null", &readNull},
                                            {"mask", &readMask},
                                            {"bumpmap", &readBumpMap},
                                            {"normalmap", &readNormalMap}};
  return kPlugins;
}

std::span<const BsdfPlugin> replacedBsdfPlugins() {
  static constexpr BsdfPlugin kPlugins[] = {{"roughdiffuse", &readRoughDiffuse}, {"ward", &readWard}};
  return kPlugins;
}

// `scale` is of Mitsuba 0.6.
std::span<const TexturePlugin> texturePlugins() {
  static constexpr TexturePlugin kPlugins[] = {{"bitmap", &readBitmapTexture},
                                               {"checkerboard", &readCheckerboard},
                                               {"mesh_attribute", &readMeshAttribute},
                                               {"rawconstant", &readRawConstant},
                                               {"scale", &readScaleTexture}};
  return kPlugins;
}

// `shapegroup` and `instance` are handled by addShape.
std::span<const ShapePlugin> shapePlugins() {
  static constexpr ShapePlugin kPlugins[] = {{"rectangle", &readRectangle}, {"cube", &readCube},
                                             {"sphere", &readSphere},       {"disk", &readDisk},
                                             {"cylinder", &readCylinder},   {"ply", &readPlyShape},
                                             {"obj", &readObjShape},        {"serialized", &readSerializedShape}};
  return kPlugins;
}

// `sky` and `sun` are of Mitsuba 0.5 and 0.6.
std::span<const EmitterPlugin> emitterPlugins() {
  static constexpr EmitterPlugin kPlugins[] = {{"point", &readPoint},         {"spot", &readSpot},
                                               {"projector", &readProjector}, {"directional", &readDirectional},
                                               {"constant", &readConstant},   {"envmap", &readEnvmap},
                                               {"sunsky", &readSunsky},       {"sky", &readSunsky},
                                               {"sun", &readSunsky}};
  return kPlugins;
}

// The first one stands in for unknown sensors with --lenient.
std::span<const SensorPlugin> sensorPlugins() {
  static constexpr SensorPlugin kPlugins[] = {
      {"perspective", &readPerspective}, {"thinlens", &readThinLens}, {"orthographic", &readOrthographic}};
  return kPlugins;
}

// readFilm replaces `mitchell`, `catmullrom` and `lanczos` by a gaussian.
std::span<const FilterPlugin> filterPlugins() {
  static constexpr FilterPlugin kPlugins[] = {
      {"box", &readBoxFilter}, {"tent", &readTentFilter}, {"gaussian", &readGaussianFilter}};
  return kPlugins;
}

}  // namespace wavecrest
