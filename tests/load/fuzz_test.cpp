// Ten thousand damaged scene, PLY and OBJ files: each either loads or ends in a LoadError, within its time.
//
// Inputs are deterministic: case i mutates one of the seeds below with a generator seeded by i. A failure prints its
// case; WAVECREST_FUZZ_CASE=i runs that one alone. Meant for the asan-ubsan preset, where any misuse of memory and any
// undefined behaviour ends the process.
#include <chrono>
#include <cstdlib>
#include <random>

#include "metrics/image/image_io.h"
#include "tests/load/mesh_text.h"
#include "tests/load/scene_file.h"

namespace wavecrest::testing {
namespace {

using Random = std::mt19937_64;

constexpr int kCases = 10'000;
constexpr double kSecondsPerCase = 5;

// One file of each kind that uses most of what its format can say.
constexpr std::string_view kSceneSeed = R"(<scene version="3.0.0">
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
  <bsdf type="mask" id="veil"><float name="opacity" value="0.3"/><bsdf type="roughplastic"/></bsdf>
  <shape type="ply"><string name="filename" value="mesh.ply"/><ref id="gold"/></shape>
  <shape type="obj"><string name="filename" value="mesh.obj"/><ref id="red"/>
    <transform name="to_world"><rotate x="1" angle="30"/><translate x="1" y="2" z="3"/></transform></shape>
  <shape type="sphere"><point name="center" x="0" y="1" z="0"/><float name="radius" value="0.5"/>
    <bsdf type="dielectric"><string name="int_ior" value="bk7"/></bsdf></shape>
  <shape type="shapegroup" id="group"><shape type="cube"><ref id="veil"/></shape><shape type="cylinder"/></shape>
  <shape type="instance"><ref id="group"/><transform name="to_world"><scale value="2"/></transform></shape>
  <shape type="rectangle"><emitter type="area"><rgb name="radiance" value="17, 12, 4"/></emitter></shape>
  <emitter type="spot"><spectrum name="intensity" value="400:1, 500:2, 600:3"/></emitter>
  <emitter type="constant"><srgb name="radiance" value="#8080ff"/></emitter>
  <include filename="part.xml"/>
</scene>
)";
constexpr std::string_view kPartSeed = R"(<scene version="0.6.0">
  <shape type="disk"><transform name="toWorld"><matrix value="1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"/></transform>
    <bsdf type="phong"><float name="exponent" value="20"/></bsdf></shape>
</scene>
)";
constexpr std::string_view kObjSeed =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0.5\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1 4/1/1\nf -4 -3 -1\n"
    "f 1//1 2//1 4//1\n";
constexpr std::string_view kUvPlySeed =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\n"
    "property float ny\nproperty float nz\nproperty float u\nproperty float v\nelement face 1\nproperty list uchar int "
    "vertex_indices\nproperty float quality\nend_header\n0 0 0 0 0 1 0 0\n1 0 0 0 0 1 1 0\n0 1 0 0 0 1 0 1\n3 0 1 2 "
    ".5\n";

// Fragments that sit at the edges of what parsers accept.
constexpr std::string_view kFragments[] = {"-1",
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

size_t below(Random& random, size_t bound) { return bound == 0 ? 0 : static_cast<size_t>(random() % bound); }

std::string mutated(std::string text, Random& random) {
  const size_t count = 1 + below(random, 3);
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
      default:  // a digit to another
        for (size_t j = at; j < text.size(); ++j) {
          if (text[j] < '0' || text[j] > '9') continue;
          text[j] = static_cast<char>('0' + below(random, 10));
          break;
        }
    }
  }
  return text;
}

struct Outcome {
  int loaded = 0, refused = 0;
};

void runCase(int index, const Folder& folder, Outcome& outcome) {
  SCOPED_TRACE("WAVECREST_FUZZ_CASE=" + std::to_string(index));
  Random random(static_cast<uint64_t>(index));
  std::string scene(kSceneSeed), ply(kQuadPly), obj(kObjSeed), part(kPartSeed);
  switch (index % 6) {
    case 0:
      scene = mutated(scene, random);
      break;
    case 1:
      part = mutated(part, random);
      break;
    case 2:
      ply = mutated(std::string(index % 12 == 2 ? kQuadPly : kUvPlySeed), random);
      break;
    case 3:
      ply = mutated(binaryQuadPly(index % 12 == 3), random);
      break;
    case 4:
      obj = mutated(obj, random);
      break;
    default:
      ply = mutated(gzip(kUvPlySeed), random);
  }
  folder.write("part.xml", part);
  folder.write("mesh.ply", ply);
  folder.write("mesh.obj", obj);
  const std::filesystem::path path = folder.write("scene.xml", scene);
  const auto start = std::chrono::steady_clock::now();
  try {
    loadScene(path, {.lenient = index % 5 == 0});
    ++outcome.loaded;
  } catch (const LoadError& error) {
    EXPECT_FALSE(error.text.empty());
    ++outcome.refused;
  } catch (const std::exception& error) {
    ADD_FAILURE() << "not a LoadError: " << error.what();
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  EXPECT_LT(seconds, kSecondsPerCase);
}

TEST(Fuzz, DamagedFilesLoadOrAreRefused) {
  const Folder folder;
  writePng((folder.path() / "wood.png").string(), Image8{.width = 2, .height = 1, .pixels = {90, 60, 30, 120, 80, 40}});
  Outcome outcome;
  if (const char* chosen = std::getenv("WAVECREST_FUZZ_CASE")) {
    runCase(std::atoi(chosen), folder, outcome);
    return;
  }
  for (int i = 0; i < kCases && !HasFailure(); ++i) runCase(i, folder, outcome);
  // Both happen, or the mutations would be too weak or too strong to test anything.
  EXPECT_GT(outcome.loaded, kCases / 20);
  EXPECT_GT(outcome.refused, kCases / 4);
}

TEST(Fuzz, TheUndamagedFilesLoad) {
  const Folder folder;
  writePng((folder.path() / "wood.png").string(), Image8{.width = 1, .height = 1, .pixels = {90, 60, 30}});
  folder.write("part.xml", kPartSeed);
  folder.write("mesh.obj", kObjSeed);
  for (const std::string& ply : {std::string(kQuadPly), binaryQuadPly(false), binaryQuadPly(true), gzip(kUvPlySeed)}) {
    folder.write("mesh.ply", ply);
    EXPECT_EQ(load(folder, kSceneSeed).shapes.size(), 7u);
  }
}

}  // namespace
}  // namespace wavecrest::testing
