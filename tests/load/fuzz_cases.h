// Damaged scene, PLY, OBJ, serialized, BMP, TGA and JPEG files for the tests that nothing in them may crash, hang or
// fill the memory.
//
// Case i mutates one of the seeds below with a generator seeded by i, so a case is its number. How many of them a test
// takes comes from WAVECREST_FUZZ_CASES, the first from WAVECREST_FUZZ_FIRST; WAVECREST_FUZZ_CASE=i picks one alone.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <string_view>
#include <utility>

#include "metrics/image/image_io.h"
#include "tests/load/mesh_text.h"
#include "tests/load/scene_file.h"

namespace wavecrest {

constexpr int kFewCases = 1'000;  // of a test that nobody asked for more
constexpr double kSecondsPerCase = 5;
constexpr size_t kMostMemory = size_t{1} << 30;

using Random = std::mt19937_64;

// One file of each kind that uses most of what its format can say. No scene but that of materials has a roughplastic,
// whose table takes longer than all else of a case.
inline constexpr std::string_view kSceneSeed = R"(<scene version="3.0.0">
  <default name="size" value="32"/>
  <integrator type="path"><integer name="max_depth" value="6"/></integrator>
  <sensor type="thinlens">
    <float name="fov" value="40"/><string name="fov_axis" value="smaller"/><float name="aperture_radius" value="0.1"/>
    <transform name="to_world"><lookat origin="0, 1, 5" target="0, 0, 0" up="0, 1, 0"/></transform>
    <film type="hdrfilm"><integer name="width" value="$size"/><integer name="height" value="$size"/>
      <rfilter type="gaussian"><float name="stddev" value="0.4"/></rfilter></film>
    <sampler type="independent"><integer name="sample_count" value="16"/></sampler>
  </sensor>
  <texture type="bitmap" id="wood"><string name="filename" value="wood.png"/>
    <transform name="to_uv"><scale x="2" y="3"/></transform></texture>
  <bsdf type="twosided" id="red"><bsdf type="diffuse"><ref id="wood" name="reflectance"/></bsdf></bsdf>
  <bsdf type="roughconductor" id="gold"><string name="material" value="Au"/><float name="alpha" value="0.2"/></bsdf>
  <bsdf type="bumpmap" id="bumpy"><ref id="wood" name="arbitrary"/><float name="scale" value="0.5"/>
    <boolean name="flip_invalid_normals" value="false"/><boolean name="use_shadowing_function" value="false"/>
    <bsdf type="plastic"/></bsdf>
  <bsdf type="mask" id="veil"><float name="opacity" value="0.3"/><bsdf type="conductor"/></bsdf>
  <shape type="ply"><string name="filename" value="mesh.ply"/><ref id="gold"/></shape>
  <shape type="serialized"><string name="filename" value="mesh.serialized"/>
    <integer name="shape_index" value="1"/><bsdf type="diffuse"><texture type="bitmap" name="reflectance">
    <string name="filename" value="wood.bmp"/></texture></bsdf></shape>
  <shape type="rectangle"><bsdf type="diffuse"><texture type="scale" name="reflectance">
    <float name="scale" value="0.5"/><texture type="bitmap"><string name="filename" value="wood.tga"/></texture>
    </texture></bsdf></shape>
  <shape type="obj"><string name="filename" value="mesh.obj"/><ref id="red"/>
    <transform name="to_world"><rotate x="1" angle="30"/><translate x="1" y="2" z="3"/></transform></shape>
  <shape type="sphere"><point name="center" x="0" y="1" z="0"/><float name="radius" value="0.5"/>
    <bsdf type="dielectric"><string name="int_ior" value="bk7"/></bsdf></shape>
  <shape type="shapegroup" id="group"><shape type="cube"><ref id="veil"/></shape><shape type="cylinder"><ref id="bumpy"/></shape></shape>
  <shape type="instance"><ref id="group"/><transform name="to_world"><scale value="2"/></transform></shape>
  <shape type="rectangle"><emitter type="area"><rgb name="radiance" value="17, 12, 4"/></emitter></shape>
  <emitter type="spot"><spectrum name="intensity" value="400:1, 500:2, 600:3"/>
    <texture type="bitmap" name="texture"><string name="filename" value="wood.jpg"/></texture></emitter>
  <emitter type="projector"><ref id="wood" name="irradiance"/><float name="scale" value="3"/>
    <float name="fov" value="45"/><string name="fov_axis" value="diagonal"/>
    <transform name="to_world"><lookat origin="0, 4, 0" target="0, 0, 0" up="0, 0, 1"/></transform></emitter>
  <emitter type="envmap"><string name="filename" value="wood.png"/><float name="scale" value="0.5"/></emitter>
  <include filename="part.xml"/>
</scene>
)";
// What the first cannot have: a second kind of environment, in the names of 0.6.
inline constexpr std::string_view kSkySeed = R"(<scene version="0.6.0">
  <integrator type="path"><boolean name="hideEmitters" value="true"/></integrator>
  <sensor type="perspective"><transform name="toWorld"><lookAt origin="0, 1, 5" target="0, 0, 0" up="0, 1, 0"/>
    </transform><film type="ldrfilm"><integer name="width" value="32"/><integer name="height" value="24"/></film></sensor>
  <shape type="sphere"><bsdf type="diffuse"><srgb name="reflectance" value="#a05030"/></bsdf></shape>
  <emitter type="sun"><float name="turbidity" value="4.5"/><float name="scale" value="0.5"/>
    <float name="sunRadiusScale" value="2"/><integer name="year" value="2012"/><integer name="month" value="4"/>
    <integer name="day" value="9"/><float name="hour" value="11"/><float name="minute" value="30"/>
    <float name="latitude" value="50"/><float name="longitude" value="14"/><float name="timezone" value="1"/></emitter>
  <emitter type="sky"><float name="turbidity" value="4.5"/><spectrum name="albedo" value="0.3"/>
    <integer name="year" value="2012"/><integer name="month" value="4"/><integer name="day" value="9"/>
    <float name="hour" value="11"/><float name="minute" value="30"/><float name="latitude" value="50"/>
    <float name="longitude" value="14"/><float name="timezone" value="1"/></emitter>
</scene>
)";
// The same of version 3.
inline constexpr std::string_view kSunskySeed = R"(<scene version="3.0.0">
  <sensor type="perspective"><film type="hdrfilm"><integer name="width" value="32"/></film></sensor>
  <shape type="sphere"/>
  <emitter type="sunsky"><float name="turbidity" value="4"/><vector name="sun_direction" x="0.3" y="0.2" z="0.8"/>
    <rgb name="albedo" value="0.3, 0.2, 0.1"/><float name="sun_scale" value="0.8"/></emitter>
</scene>
)";
// BSDFs and textures that are made of others, and those of many parameters.
inline constexpr std::string_view kMaterialSeed = R"(<scene version="3.0.0">
  <integrator type="path"><boolean name="hide_emitters" value="true"/></integrator>
  <sensor type="orthographic"><film type="hdrfilm"><integer name="width" value="32"/><integer name="height" value="24"/>
    <rfilter type="tent"/></film></sensor>
  <texture type="checkerboard" id="squares"><float name="color0" value="0.3"/><float name="color1" value="1.2"/>
    <transform name="to_uv"><rotate z="1" angle="20"/><scale x="6" y="4"/></transform></texture>
  <texture type="bitmap" id="wood"><string name="filename" value="wood.png"/><boolean name="raw" value="true"/>
    <string name="wrap_mode" value="mirror"/><string name="filter_type" value="nearest"/></texture>
  <texture type="rawconstant" id="grey"><rgb name="value" value="0.5, 0.4, 0.3"/></texture>
  <bsdf type="principled" id="paint"><ref id="grey" name="base_color"/><ref id="wood" name="roughness"/>
    <float name="metallic" value="0.3"/><float name="anisotropic" value="0.5"/><float name="spec_trans" value="0.2"/>
    <float name="spec_tint" value="0.4"/><float name="sheen" value="0.3"/><float name="sheen_tint" value="0.6"/>
    <float name="flatness" value="0.2"/><float name="clearcoat" value="0.7"/><float name="clearcoat_gloss" value="0.9"/>
    <float name="eta" value="1.6"/></bsdf>
  <bsdf type="principledthin" id="leaf"><rgb name="base_color" value="0.2, 0.6, 0.1"/>
    <ref id="squares" name="diff_trans"/><float name="eta" value="1.4"/></bsdf>
  <bsdf type="mask" id="blend"><float name="opacity" value="0.8"/><bsdf type="blendbsdf"><float name="weight" value="0.3"/>
    <bsdf type="blendbsdf"><float name="weight" value="0.5"/><bsdf type="diffuse"/><bsdf type="conductor"/></bsdf>
    <bsdf type="roughdielectric"><string name="distribution" value="ggx"/><float name="alpha_u" value="0.3"/>
      <float name="alpha_v" value="0.1"/></bsdf></bsdf></bsdf>
  <bsdf type="blendbsdf" id="pattern"><ref id="squares" name="weight"/><bsdf type="thindielectric"/>
    <bsdf type="roughconductor"><float name="alpha_u" value="0.2"/><ref id="wood" name="alpha_v"/>
      <rgb name="eta" value="1.6, 0.9, 0.5"/><rgb name="k" value="9.2, 6.3, 4.8"/></bsdf></bsdf>
  <bsdf type="mixturebsdf" id="mixture"><string name="weights" value="0.3, 0.5"/><bsdf type="plastic"/>
    <bsdf type="roughplastic"><boolean name="nonlinear" value="true"/></bsdf></bsdf>
  <bsdf type="normalmap" id="waves"><texture type="bitmap" name="normalmap"><boolean name="raw" value="true"/>
    <string name="filename" value="wood.tga"/></texture><bsdf type="roughcoating"><float name="alpha" value="0.2"/>
    <rgb name="sigma_a" value="0.1, 0.2, 0.3"/><bsdf type="diffuse"/></bsdf></bsdf>
  <shape type="ply"><string name="filename" value="colors.ply"/><bsdf type="diffuse">
    <texture type="mesh_attribute" name="reflectance"><string name="name" value="vertex_color"/></texture></bsdf></shape>
  <shape type="shapegroup" id="group"><shape type="disk"><ref id="paint"/></shape>
    <shape type="ply"><string name="filename" value="mesh.ply"/><ref id="leaf"/></shape></shape>
  <shape type="instance"><ref id="group"/><transform name="to_world"><translate y="2"/></transform></shape>
  <shape type="instance"><ref id="group"/><transform name="to_world"><scale x="-1"/><rotate y="1" angle="40"/></transform>
  </shape>
  <shape type="sphere"><ref id="blend"/></shape>
  <shape type="cylinder"><ref id="pattern"/></shape>
  <shape type="cube"><ref id="mixture"/></shape>
  <shape type="rectangle"><ref id="waves"/></shape>
  <emitter type="constant"/>
</scene>
)";
// Colours of vertices, and nothing else that takes time.
inline constexpr std::string_view kColorSeed = R"(<scene version="3.0.0">
  <sensor type="perspective"><film type="hdrfilm"><integer name="width" value="32"/></film></sensor>
  <shape type="ply"><string name="filename" value="colors.ply"/><bsdf type="diffuse">
    <texture type="mesh_attribute" name="reflectance"><string name="name" value="vertex_color"/></texture></bsdf></shape>
  <emitter type="constant"/>
</scene>
)";
inline constexpr std::string_view kPartSeed = R"(<scene version="0.6.0">
  <shape type="disk"><transform name="toWorld"><matrix value="1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"/></transform>
    <bsdf type="phong"><float name="exponent" value="20"/></bsdf></shape>
</scene>
)";
// A sky takes longer to bake than the rest to load.
inline constexpr std::string_view kSceneSeeds[] = {kSceneSeed, kMaterialSeed, kSceneSeed, kMaterialSeed,
                                                   kSkySeed,   kMaterialSeed, kSceneSeed, kMaterialSeed,
                                                   kSceneSeed, kSunskySeed};
inline constexpr std::string_view kObjSeed =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0.5\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1 4/1/1\nf -4 -3 -1\n"
    "f 1//1 2//1 4//1\n";
inline constexpr std::string_view kUvPlySeed =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\n"
    "property float ny\nproperty float nz\nproperty float u\nproperty float v\nelement face 1\nproperty list uchar int "
    "vertex_indices\nproperty float quality\nend_header\n0 0 0 0 0 1 0 0\n1 0 0 0 0 1 1 0\n0 1 0 0 0 1 0 1\n3 0 1 2 "
    ".5\n";
inline constexpr std::string_view kColorPlySeed =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float "
    "color_0\nproperty float color_1\nproperty float color_2\nelement face 1\nproperty list uchar int "
    "vertex_indices\nend_header\n0 0 0 .2 .3 .4\n1 0 0 .5 .6 .7\n0 1 0 .8 .9 1\n3 0 1 2\n";

// Two pixels: red over blue with a palette, and a run of red.
inline std::string bmpSeed() {
  std::string bytes = "BM";
  for (const uint32_t value : {70u, 0u, 62u, 40u, 1u, 2u, 0x80001u, 0u, 8u, 0u, 0u, 2u, 0u}) {
    appendValue<uint32_t>(bytes, value, false);
  }
  return bytes + std::string("\0\0\xff\0\xff\0\0\0\1\0\0\0\0\0\0\0", 16);
}
inline std::string tgaSeed() { return std::string("\0\0\x0a\0\0\0\0\0\0\0\0\0\1\0\2\0\x18\0\x81\0\0\xff", 22); }
inline std::string jpegSeed() {
  std::ifstream file(WAVECREST_SCENES "/features/gradient.jpg", std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}
inline std::string serializedSeed() { return serializedFile({serializedQuad(), serializedQuad({.colors = true})}); }

// Fragments that sit at the edges of what parsers accept.
inline constexpr std::string_view kFragments[] = {"-1",
                                                  "0",
                                                  "1e39",
                                                  "1e-400",
                                                  "-1e999",
                                                  "nan",
                                                  "inf",
                                                  "4294967295",
                                                  "4294967296",
                                                  "-2147483649",
                                                  "99999999999999999999",
                                                  "0x7f",
                                                  "",
                                                  " ",
                                                  "\n",
                                                  "\"",
                                                  "<",
                                                  ">",
                                                  "/>",
                                                  "</scene>",
                                                  "&amp;",
                                                  "&#0;",
                                                  "$size",
                                                  "$",
                                                  "\\$",
                                                  "<ref id=\"red\"/>",
                                                  "<ref id=\"group\"/>",
                                                  "<include filename=\"part.xml\"/>",
                                                  "<include filename=\"scene.xml\"/>",
                                                  "<default name=\"a\" value=\"$a$a\"/>",
                                                  "<shape type=\"sphere\"/>",
                                                  "<bsdf type=\"twosided\">",
                                                  "true",
                                                  "list",
                                                  "uchar",
                                                  "double",
                                                  "element vertex 3\n",
                                                  "element face 4000000000\n",
                                                  "end_header\n",
                                                  "property list uchar int x\n",
                                                  "f 1 2 3\n",
                                                  "f 1/2/3/4 2 3\n",
                                                  "v 1 2\n",
                                                  "//",
                                                  "\xff\xfe",
                                                  "<![CDATA["};

inline size_t below(Random& random, size_t bound) { return bound == 0 ? 0 : static_cast<size_t>(random() % bound); }

// Another digit for one somewhere after `at`: sizes, counts, indices and coordinates change, the grammar does not.
inline void changeDigit(std::string& text, size_t at, Random& random) {
  const size_t digit = text.find_first_of("0123456789", at);
  if (digit != std::string::npos) text[digit] = static_cast<char>('0' + below(random, 10));
}

// Every second file keeps its grammar, so that many get past the parsers.
inline std::string mutated(std::string text, Random& random) {
  const size_t count = 1 + below(random, 3);
  if (below(random, 2) == 0) {
    for (size_t i = 0; i < count; ++i) changeDigit(text, below(random, text.size() + 1), random);
    return text;
  }
  for (size_t i = 0; i < count; ++i) {
    const size_t at = below(random, text.size() + 1), length = below(random, 1 + text.size() - at);
    const size_t some = std::min<size_t>(length, 1 + below(random, 24));
    switch (below(random, 7)) {
      case 0:  // one bit
        if (at < text.size()) text[at] = static_cast<char>(text[at] ^ (1 << below(random, 8)));
        break;
      case 1:
        text.replace(at, some, kFragments[below(random, std::size(kFragments))]);
        break;
      case 2:
        text.insert(at, kFragments[below(random, std::size(kFragments))]);
        break;
      case 3:
        text.erase(at, some);
        break;
      case 4:
        text.insert(below(random, text.size() + 1), text.substr(at, length));
        break;  // repeat a piece elsewhere
      case 5:
        text.resize(at);
        break;  // truncate
      default:
        changeDigit(text, at, random);
    }
  }
  return text;
}

// The undamaged files of which case i damages one.
inline void writeSeeds(const Folder& folder) {
  writePng((folder.path() / "wood.png").string(), Image8{.width = 2, .height = 1, .pixels = {90, 60, 30, 120, 80, 40}});
  folder.write("wood.bmp", bmpSeed());
  folder.write("wood.tga", tgaSeed());
  folder.write("wood.jpg", jpegSeed());
  folder.write("mesh.serialized", serializedSeed());
  folder.write("part.xml", kPartSeed);
  folder.write("mesh.ply", kQuadPly);
  folder.write("colors.ply", kColorPlySeed);
  folder.write("mesh.obj", kObjSeed);
  folder.write("scene.xml", kSceneSeed);
}

inline bool isLenient(int index) { return index / 10 % 5 == 0; }

// Writes all files of case `index` over those of the folder; returns the scene's.
inline std::filesystem::path writeCase(const Folder& folder, int index) {
  Random random(static_cast<uint64_t>(index));
  std::string scene(kSceneSeed), ply(kQuadPly), colors(kColorPlySeed), obj(kObjSeed), part(kPartSeed);
  std::string serialized = serializedSeed(), bmp = bmpSeed(), tga = tgaSeed(), jpeg = jpegSeed();
  switch (index % 10) {
    case 0:
      scene = mutated(std::string(kSceneSeeds[static_cast<size_t>(index / 10) % std::size(kSceneSeeds)]), random);
      break;
    case 1:
      part = mutated(part, random);
      break;
    case 2:
      if (index % 40 == 12) {
        scene = kColorSeed;
        colors = mutated(colors, random);
        break;
      }
      ply = mutated(std::string(index % 20 == 2 ? kQuadPly : kUvPlySeed), random);
      break;
    case 3:
      ply = mutated(binaryQuadPly(index % 20 == 3), random);
      break;
    case 4:
      obj = mutated(obj, random);
      break;
    case 5:
      serialized = below(random, 2) == 0
                       ? mutated(serialized, random)
                       : serializedFile({serializedQuad(), serializedMeshOf(mutated(serializedBody(), random))});
      break;
    case 6:
      bmp = mutated(bmp, random);
      break;
    case 7:
      tga = mutated(tga, random);
      break;
    case 8:
      jpeg = mutated(jpeg, random);
      break;
    default:
      ply = mutated(gzip(kUvPlySeed), random);
  }
  folder.write("part.xml", part);
  folder.write("mesh.ply", ply);
  folder.write("colors.ply", colors);
  folder.write("mesh.obj", obj);
  folder.write("mesh.serialized", serialized);
  folder.write("wood.bmp", bmp);
  folder.write("wood.tga", tga);
  folder.write("wood.jpg", jpeg);
  return folder.write("scene.xml", scene);
}

// First and one past the last case to run.
inline std::pair<int, int> casesToRun() {
  if (const char* chosen = std::getenv("WAVECREST_FUZZ_CASE")) return {std::atoi(chosen), std::atoi(chosen) + 1};
  const char* const first = std::getenv("WAVECREST_FUZZ_FIRST");
  const char* const count = std::getenv("WAVECREST_FUZZ_CASES");
  const int start = first != nullptr ? std::atoi(first) : 0;
  return {start, start + (count != nullptr ? std::atoi(count) : kFewCases)};
}

}  // namespace wavecrest
