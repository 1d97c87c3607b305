// Notes: what a scene asks for that is approximated or left out is listed, and nothing else is.
#include "metrics/image/image_io.h"
#include "tests/load/scene_file.h"

namespace wavecrest {
namespace {

void expectNote(const Scene& scene, std::string_view what, std::string_view effect) {
  ASSERT_EQ(scene.notes.size(), 1u);
  EXPECT_NE(scene.notes[0].what.find(what), std::string::npos) << scene.notes[0].what;
  EXPECT_NE(scene.notes[0].effect.find(effect), std::string::npos) << scene.notes[0].effect;
}

TEST(Notes, PlainSceneHasNone) {
  EXPECT_TRUE(loadBody(R"(<integrator type="path"><integer name="max_depth" value="5"/></integrator>
      <sensor type="perspective"><film type="hdrfilm"><rfilter type="gaussian"/></film>
      <sampler type="independent"/></sensor>)")
                  .notes.empty());
}

TEST(Notes, NameFileAndLine) {
  const Folder folder;
  const Scene scene =
      load(folder, sceneXml("\n<integrator type=\"bdpt\"/>" + std::string(kSensor) + std::string(kSphere)));
  ASSERT_EQ(scene.notes.size(), 1u);
  EXPECT_EQ(scene.notes[0].source.file, (folder.path() / "scene.xml").string());
  EXPECT_EQ(scene.notes[0].source.line, 2);
}

TEST(Notes, EqualOnesAreCounted) {
  const std::string shape = R"(<shape type="ply"><string name="filename" value="mesh.ply"/>
      <float name="max_smooth_angle" value="30"/></shape>)";
  const Folder folder;
  folder.write("mesh.ply",
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
               "z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 "
               "0\n3 0 1 2\n");
  const Scene scene = loadBody(folder, shape + shape);
  ASSERT_EQ(scene.notes.size(), 1u);
  EXPECT_EQ(scene.notes[0].count, 2u);
  EXPECT_EQ(scene.notes[0].effect, "normals of the file are kept, others are smoothed over edges of any angle");
}

TEST(Notes, IntegratorsNameTheLikeMethod) {
  const std::pair<const char*, const char*> kinds[] = {{"bdpt", "--method bpt"},
                                                       {"ptracer", "--method lt"},
                                                       {"sppm", "--method ppm"},
                                                       {"pssmlt", "--method mlt is"},
                                                       {"mlt", "--method mlt --mlt pathspace is"},
                                                       {"photonmapper", "--method ppm --direct-pass is"},
                                                       {"vcm", "--method vcm"},
                                                       {"ao", "no method here is like it"}};
  for (const auto& [type, text] : kinds) {
    expectNote(loadBody("<integrator type=\"" + std::string(type) + "\"/>"), type, text);
  }
}

TEST(Notes, ParametersOfAnIntegratorAreNamed) {
  expectNote(loadBody(R"(<integrator type="sppm"><float name="alpha" value="0.9"/></integrator>)"),
             "integrator \"sppm\" with alpha", "--method ppm");
}

TEST(Notes, OfAPathTracerOnlyWhatGuidesSamplingIsLeftOut) {
  expectNote(loadBody(R"(<integrator type="direct"><integer name="emitter_samples" value="2"/></integrator>)"),
             "integrator \"direct\" with emitter_samples", "left out: guides how the integrator samples");
  const auto strict = [](const std::string& value) {
    return loadBody(R"(<integrator type="path"><boolean name="strict_normals" value=")" + value + "\"/></integrator>");
  };
  expectNote(strict("true"), "\"strict_normals\" of integrator \"path\"", "shading normals alone decide");
  EXPECT_TRUE(strict("false").notes.empty());
}

TEST(Notes, UnknownParametersOfIntegrators) {
  const std::string parameter = R"(<float name="clamping" value="0.1"/></integrator>)",
                    vpl = R"(<integrator type="vpl">)" + parameter;
  expectNote(load(sceneXml(vpl + std::string(kSensor) + std::string(kSphere), "0.6.0")),
             "parameter \"clamping\" of integrator \"vpl\"", "wavecrest does not know it");
  expectErrorOnLine2(vpl, "unknown parameter \"clamping\" of integrator \"vpl\"");
  expectErrorOnLine2(R"(<integrator type="path"><integer name="maxDepth" value="3"/></integrator>)",
                     "unknown parameter \"maxDepth\" of integrator \"path\"; expected max_depth, rr_depth");
  expectNote(loadBody(R"(<integrator type="ao">)" + parameter), "with clamping", "no method here is like it");
}

TEST(Notes, SamplersAndFiltersThatAreReplaced) {
  expectNote(loadBody(R"(<sensor type="perspective"><sampler type="ldsampler"/></sensor>)"), "ldsampler", "--sampler");
  expectNote(loadBody(R"(<sensor type="perspective"><film type="hdrfilm"><rfilter type="lanczos"/></film></sensor>)"),
             "lanczos", "gaussian");
  expectNote(loadBody(R"(<sensor type="perspective"><film type="ldrfilm"/></sensor>)"), "ldrfilm", "hdrfilm");
}

TEST(Notes, UnknownParametersOfOldFiles) {
  const std::string body = R"(<shape type="sphere"><float name="wobble" value="1"/></shape>)" + std::string(kSensor);
  expectNote(load(sceneXml(body, "0.6.0")), "parameter \"wobble\" of shape \"sphere\"", "left out");
  expectError(sceneXml(body), 1, "unknown parameter \"wobble\"");
}

TEST(Notes, ColouredOpacitiesOfOldFiles) {
  const auto sceneOf = [](const std::string& opacity, std::string_view version) {
    return load(sceneXml(R"(<shape type="sphere"><bsdf type="mask">)" + opacity +
                             R"(<bsdf type="diffuse"/></bsdf></shape>)" + std::string(kSensor),
                         version));
  };
  const std::string color = R"(<rgb name="opacity" value="0.3, 0.6, 0"/>)",
                    grey = R"(<rgb name="opacity" value="0.3"/>)",
                    board =
                        R"(<texture type="checkerboard" name="opacity"><rgb name="color1" value="1, 0, 0"/></texture>)";
  expectNote(sceneOf(color, "0.6.0"), "coloured opacity of a mask", "one number for all channels");
  expectNote(sceneOf(board, "0.6.0"), "coloured opacity of a mask", "one number for all channels");
  EXPECT_TRUE(sceneOf(grey, "0.6.0").notes.empty());
  EXPECT_TRUE(sceneOf("", "0.6.0").notes.empty());
  EXPECT_TRUE(sceneOf(color, "3.0.0").notes.empty()) << "as in Mitsuba 3";
}

TEST(Notes, ColouredBitmapsAsOpacitiesOfOldFiles) {
  const Folder folder;
  const auto notesOf = [&](const Image8& image) {
    writePng((folder.path() / "opacity.png").string(), image);
    return load(folder, sceneXml(R"(<shape type="sphere"><bsdf type="mask"><texture type="bitmap" name="opacity">
        <string name="filename" value="opacity.png"/></texture><bsdf type="diffuse"/></bsdf></shape>)" +
                                     std::string(kSensor),
                                 "0.6.0"))
        .notes.size();
  };
  EXPECT_EQ(notesOf({.width = 2, .height = 1, .pixels = {9, 9, 9, 9, 9, 10}}), 1u);
  EXPECT_EQ(notesOf({.width = 2, .height = 1, .pixels = {9, 9, 9, 10, 10, 10}}), 0u);
}

// Mitsuba 3 takes the axis as it is: its matrix is no rotation then.
TEST(Notes, RotationsAboutAnAxisOfAnotherLength) {
  const auto scene = [](const std::string& axis) {
    return loadBody(R"(<shape type="cube"><transform name="to_world"><rotate angle="15" )" + axis +
                    "/></transform></shape>");
  };
  expectNote(scene(R"(y="1" z="1")"), "another length than 1", "direction counts");
  EXPECT_TRUE(scene(R"(y="0.7071" z="0.7071")").notes.empty());
}

}  // namespace
}  // namespace wavecrest
