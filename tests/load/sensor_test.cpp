// Cameras, film, filters, and what integrator and sampler ask for.
#include <cmath>
#include <numbers>

#include "tests/load/scene_file.h"

namespace wavecrest {
namespace {

Scene sceneOf(std::string_view sensorContent, std::string_view type = "perspective", const LoadOptions& options = {}) {
  return loadBody("<sensor type=\"" + std::string(type) + "\">" + std::string(sensorContent) + "</sensor>", options);
}
void expectSensorError(std::string_view content, std::string_view text, std::string_view type = "perspective") {
  expectError(sceneXml("\n<sensor type=\"" + std::string(type) + "\">" + std::string(content) + "</sensor>" +
                       std::string(kSphere)),
              2, text);
}

constexpr std::string_view kTwoByOne =
    R"(<film type="hdrfilm"><integer name="width" value="200"/><integer name="height" value="100"/></film>)";
// Horizontal angle whose tangent of the half is `factor` times that of 90 degrees.
double wide(double factor) { return 2 * std::atan(factor) * 180 / std::numbers::pi; }
constexpr double kRounding = 1e-12;  // degrees

TEST(Sensor, PerspectiveDefaults) {
  const Sensor sensor = sceneOf("").sensor;
  EXPECT_EQ(sensor.kind, Sensor::Kind::perspective);
  EXPECT_EQ(sensor.nearClip, 1e-2);
  EXPECT_EQ(sensor.farClip, 1e4);
  EXPECT_NEAR(sensor.fovX, 38.184841, 1e-5);  // 50 mm on a film of 4:3; Mitsuba 3.9
  EXPECT_EQ(sensor.principalPointOffset, (std::array<double, 2>{0, 0}));
}

TEST(Sensor, FovAxisX) {
  EXPECT_EQ(sceneOf(std::string(kTwoByOne) + R"(<float name="fov" value="90"/>)").sensor.fovX, 90);
}

TEST(Sensor, FovAxisYFollowsTheAspect) {
  EXPECT_NEAR(sceneOf(std::string(kTwoByOne) + R"(<float name="fov" value="90"/><string name="fov_axis" value="y"/>)")
                  .sensor.fovX,
              wide(2), kRounding);
}

TEST(Sensor, FovAxisSmallerAndLarger) {
  const std::string fov = std::string(kTwoByOne) + R"(<float name="fov" value="90"/><string name="fov_axis" value=)";
  EXPECT_NEAR(sceneOf(fov + R"("smaller"/>)").sensor.fovX, wide(2), kRounding);
  EXPECT_NEAR(sceneOf(fov + R"("larger"/>)").sensor.fovX, 90, kRounding);
}

TEST(Sensor, FovAxisDiagonal) {
  EXPECT_NEAR(
      sceneOf(std::string(kTwoByOne) + R"(<float name="fov" value="90"/><string name="fov_axis" value="diagonal"/>)")
          .sensor.fovX,
      wide(2 / std::sqrt(5.0)), kRounding);
}

TEST(Sensor, FocalLengthRefersToTheDiagonalOf35mmFilm) {
  const double halfDiagonal = std::sqrt(36.0 * 36 + 24 * 24) / 2 / 25;
  EXPECT_NEAR(sceneOf(std::string(kTwoByOne) + R"(<string name="focal_length" value="25mm"/>)").sensor.fovX,
              wide(halfDiagonal * 2 / std::sqrt(5.0)), kRounding);
}

TEST(Sensor, SizeFromOutsideChangesTheFieldOfView) {
  const Scene scene =
      sceneOf(std::string(kTwoByOne) + R"(<float name="fov" value="90"/><string name="fov_axis" value="y"/>)",
              "perspective", {.filmSize = {{300, 100}}});
  EXPECT_EQ(scene.film.width, 300u);
  EXPECT_NEAR(scene.sensor.fovX, wide(3), kRounding);
}

TEST(Sensor, ThinLensTakesApertureAndFocus) {
  const Sensor sensor =
      sceneOf(R"(<float name="aperture_radius" value="0.1"/><float name="focus_distance" value="5"/>)", "thinlens")
          .sensor;
  EXPECT_EQ(sensor.kind, Sensor::Kind::thinlens);
  EXPECT_EQ(sensor.apertureRadius, 0.1);
  EXPECT_EQ(sensor.focusDistance, 5);
}

TEST(Sensor, ThinLensFocusesAtTheFarClip) {
  EXPECT_EQ(sceneOf(R"(<float name="aperture_radius" value="0.1"/>)", "thinlens").sensor.focusDistance, 1e4);
}

TEST(Sensor, ThinLensNeedsAnAperture) { expectSensorError("", "has no \"aperture_radius\"", "thinlens"); }

TEST(Sensor, OrthographicMayScale) {
  const Sensor sensor =
      sceneOf(R"(<transform name="to_world"><scale x="3" y="3"/></transform>)", "orthographic").sensor;
  EXPECT_EQ(sensor.kind, Sensor::Kind::orthographic);
  EXPECT_EQ(sensor.toWorld[0][0], 3);
}

TEST(Sensor, OrthographicMayNotShearOrFlatten) {
  expectSensorError(R"(<transform name="to_world"><matrix value="1 0.1 0 0 0 1 0 0 0 0 1 0 0 0 0 1"/></transform>)",
                    "shears or flattens", "orthographic");
  expectSensorError(R"(<transform name="to_world"><matrix value="1 0 0 0 0 0 0 0 0 0 1 0 0 0 0 1"/></transform>)",
                    "; expected", "orthographic");
}

TEST(Sensor, OnlyTheFirstIsUsedAndAWarningSaysSo) {
  const Scene scene = loadBody(R"(<sensor type="perspective"><float name="fov" value="30"/></sensor>
    <sensor type="perspective"><float name="fov" value="60"/></sensor>)");
  EXPECT_EQ(scene.sensor.fovX, 30);
  ASSERT_EQ(scene.notes.size(), 1u);
  EXPECT_EQ(scene.notes[0].what, "2 sensors");
}

TEST(Sensor, MistakesAreErrors) {
  expectSensorError(R"(<float name="fov" value="180"/>)", "field of view is 180");
  expectSensorError(R"(<float name="fov" value="0"/>)", "field of view is 0");
  expectSensorError(R"(<float name="fov" value="30"/><string name="fov_axis" value="z"/>)", "unknown fov_axis \"z\"");
  expectSensorError(R"(<float name="fov" value="30"/><string name="focal_length" value="50mm"/>)", "one of the two");
  expectSensorError(R"(<string name="focal_length" value="fiftymm"/>)", "bad number");
  expectSensorError(R"(<transform name="to_world"><scale value="2"/></transform>)", "scales or shears");
  expectSensorError(R"(<float name="near_clip" value="0"/>)", "not positive");
  expectSensorError(R"(<float name="near_clip" value="5"/><float name="far_clip" value="2"/>)", "not below far_clip");
  expectSensorError(R"(<film type="hdrfilm"/><film type="hdrfilm"/>)", "more than one film");
}

TEST(Film, Defaults) {
  const FilmSettings film = sceneOf("").film;
  EXPECT_EQ(film.width, 768u);
  EXPECT_EQ(film.height, 576u);
  EXPECT_EQ(film.cropWidth, 0u);
  EXPECT_EQ(film.filter, ReconstructionFilter::gaussian);
  EXPECT_EQ(film.gaussianStddev, 0.5);
  EXPECT_EQ(film.filterRadius, 2);
}

TEST(Film, HasMitsubasFilterWhenItNamesNone) {
  EXPECT_EQ(sceneOf(kTwoByOne).film.filter, ReconstructionFilter::gaussian);
}

TEST(Film, BoxAndTentFilters) {
  const FilmSettings box = sceneOf(R"(<film type="hdrfilm"><rfilter type="box"/></film>)").film;
  EXPECT_EQ(box.filter, ReconstructionFilter::box);
  EXPECT_EQ(box.filterRadius, 0.5);
  const FilmSettings tent = sceneOf(R"(<film type="hdrfilm"><rfilter type="tent"/></film>)").film;
  EXPECT_EQ(tent.filter, ReconstructionFilter::tent);
  EXPECT_EQ(tent.filterRadius, 1);
}

TEST(Film, BoxIsAPixelWideWhateverTheFileSays) {
  const auto boxOf = [](const std::string& radius) {
    return sceneOf(R"(<film type="hdrfilm"><rfilter type="box"><float name="radius" value=")" + radius +
                   R"("/></rfilter></film>)");
  };
  const Scene wide = boxOf("2");
  EXPECT_EQ(wide.film.filterRadius, 0.5);
  ASSERT_EQ(wide.notes.size(), 1u);
  EXPECT_EQ(wide.notes[0].what, "\"radius\" of rfilter \"box\"");
  EXPECT_TRUE(boxOf("0.5").notes.empty());
  EXPECT_EQ(wide.hash, boxOf("0.5").hash);
}

TEST(Film, GaussianIsCutAtFourStandardDeviations) {
  const FilmSettings film =
      sceneOf(R"(<film type="hdrfilm"><rfilter type="gaussian"><float name="stddev" value="1.5"/></rfilter></film>)")
          .film;
  EXPECT_EQ(film.gaussianStddev, 1.5);
  EXPECT_EQ(film.filterRadius, 6);
}

constexpr std::string_view kCrop =
    R"(<film type="hdrfilm"><integer name="width" value="200"/><integer name="height" value="100"/>
  <integer name="crop_offset_x" value="10"/><integer name="crop_offset_y" value="20"/><integer name="crop_width" value="30"/>
  <integer name="crop_height" value="40"/></film>)";

TEST(Film, CropWindow) {
  const FilmSettings film = sceneOf(kCrop).film;
  EXPECT_EQ((std::array{film.cropX, film.cropY, film.cropWidth, film.cropHeight}), (std::array{10u, 20u, 30u, 40u}));
}

TEST(Film, SizeFromOutsideDropsTheCropWindow) {
  const Scene scene = sceneOf(kCrop, "perspective", {.filmSize = {{64, 32}}});
  const FilmSettings& film = scene.film;
  EXPECT_EQ((std::array{film.width, film.height, film.cropX, film.cropWidth}), (std::array{64u, 32u, 0u, 0u}));
  ASSERT_EQ(scene.notes.size(), 1u);
  EXPECT_EQ(scene.notes[0].what, "crop window");
  EXPECT_TRUE(sceneOf(kTwoByOne, "perspective", {.filmSize = {{64, 32}}}).notes.empty());
}

// The missing side follows from the aspect ratio of the file.
TEST(Film, SidesFromOutsideAreBounded) {
  const auto widthOf = [](uint32_t height, const std::string& side) {
    const std::string file = R"(<film type="hdrfilm"><integer name="width" value=")" + side +
                             R"("/><integer name="height" value="1"/></film>)";
    return sceneOf(file, "perspective", {.filmSize = {{0, height}}}).film.width;
  };
  EXPECT_EQ(widthOf(2, "32767"), 65534u);
  EXPECT_THROW(widthOf(2, "32768"), LoadError);
  EXPECT_THROW(widthOf(3, "32768"), LoadError);
}

TEST(Film, MistakesAreErrors) {
  expectSensorError(R"(<film type="specfilm"/>)", "not supported");
  expectSensorError(R"(<film type="hdrfilm"><integer name="width" value="0"/></film>)", "\"width\" is 0; expected 1");
  expectSensorError(R"(<film type="hdrfilm"><integer name="width" value="1e3"/></film>)", "bad integer");
  expectSensorError(
      R"(<film type="hdrfilm"><integer name="width" value="32768"/><integer name="height" value="32768"/></film>)",
      "expected 1 to 2^28 pixels");
  expectSensorError(
      R"(<film type="hdrfilm"><integer name="crop_width" value="700"/><integer name="crop_offset_x" value="100"/></film>)",
      "crop window leaves the film");
  expectSensorError(R"(<film type="hdrfilm"><integer name="crop_width" value="0"/></film>)",
                    "\"crop_width\" is 0; expected 1 to");
  expectSensorError(R"(<film type="hdrfilm"><integer name="crop_height" value="0"/></film>)",
                    "\"crop_height\" is 0; expected 1 to");
  expectSensorError(R"(<film type="hdrfilm"><rfilter type="sinc"/></film>)", "rfilter \"sinc\" is not supported");
  expectSensorError(R"(<film type="hdrfilm"><rfilter type="tent"><float name="radius" value="99"/></rfilter></film>)",
                    "wider than 32 pixels");
}

TEST(Integrator, DefaultsAreUnlimitedDepthAndRouletteAfterFive) {
  const RenderDefaults defaults = loadBody(R"(<integrator type="path"/>)").defaults;
  EXPECT_EQ(defaults.maxDepth, -1);
  EXPECT_EQ(defaults.rrDepth, 5);
}

TEST(Integrator, AnyTypeIsAcceptedForItsDepths) {
  const RenderDefaults defaults = loadBody(R"(<integrator type="bdpt"><integer name="max_depth" value="7"/>
      <integer name="rr_depth" value="9"/>
      <boolean name="light_image" value="true"/></integrator>)")
                                      .defaults;
  EXPECT_EQ(defaults.maxDepth, 7);
  EXPECT_EQ(defaults.rrDepth, 9);
}

TEST(Integrator, HidesEmittersWithoutAShape) {
  const std::string hiding = R"(<integrator type="path"><boolean name="hide_emitters" value="true"/></integrator>)";
  EXPECT_TRUE(loadBody(hiding + R"(<emitter type="constant"/><emitter type="point"/>)").defaults.hideEmitters);
  EXPECT_FALSE(loadBody(R"(<integrator type="path"/>)").defaults.hideEmitters);
  expectErrorOnLine2(hiding + R"(<shape type="sphere"><emitter type="area"/></shape>)", "hide_emitters with an area");
}

TEST(Integrator, WrappersGiveTheDepthsOfTheOneWithin) {
  const RenderDefaults defaults = loadBody(R"(<integrator type="moment"><integrator type="aov">
      <string name="aovs" value="n:sh_normal"/><integrator type="path"><integer name="max_depth" value="7"/>
      <integer name="rr_depth" value="9"/></integrator></integrator></integrator>)")
                                      .defaults;
  EXPECT_EQ(defaults.maxDepth, 7);
  EXPECT_EQ(defaults.rrDepth, 9);
  EXPECT_EQ(loadBody(R"(<integrator type="moment"><integrator type="direct"/></integrator>)").defaults.maxDepth, 2);
}

TEST(Integrator, DirectIsTwoEdges) { EXPECT_EQ(loadBody(R"(<integrator type="direct"/>)").defaults.maxDepth, 2); }

TEST(Integrator, DepthDefaultsToThatOfItsType) {
  const auto depthOf = [](const std::string& type) {
    return loadBody("<integrator type=\"" + type + "\"/>").defaults.maxDepth;
  };
  for (const char* type : {"prb", "prb_basic", "prb_projective", "prb_reparam", "prbvolpath"}) {
    EXPECT_EQ(depthOf(type), 6) << type;
  }
  EXPECT_EQ(depthOf("direct_projective"), 2);
  EXPECT_EQ(depthOf("direct_reparam"), 2);
  for (const std::string type : {"direct", "direct_projective", "direct_reparam"}) {
    const Scene stated =
        loadBody("<integrator type=\"" + type + "\"><integer name=\"max_depth\" value=\"8\"/></integrator>");
    EXPECT_EQ(stated.defaults.maxDepth, 2) << type;
    ASSERT_EQ(stated.notes.size(), 1u) << type;
    EXPECT_NE(stated.notes[0].what.find("max_depth"), std::string::npos);
  }
  EXPECT_EQ(depthOf("vpl"), 5);
  EXPECT_EQ(depthOf("ptracer"), -1);
  EXPECT_EQ(loadBody(R"(<integrator type="prb"><integer name="max_depth" value="9"/></integrator>)").defaults.maxDepth,
            9);
}

TEST(Integrator, DepthBelowMinusOneIsAnError) {
  expectErrorOnLine2(R"(<integrator type="path"><integer name="max_depth" value="-2"/></integrator>)",
                     "\"max_depth\" is -2");
  expectErrorOnLine2(R"(<integrator type="path"><integer name="max_depth" value="0"/></integrator>)", "max_depth is 0");
}

TEST(Sampler, CountDefaultsToFour) { EXPECT_EQ(sceneOf("").defaults.sampleCount, 4u); }

TEST(Sampler, CountIsKept) {
  EXPECT_EQ(sceneOf(R"(<sampler type="multijitter"><integer name="sample_count" value="64"/></sampler>)")
                .defaults.sampleCount,
            64u);
}

TEST(Sampler, ParametersOfSamplersHaveNoEffectAndOthersAreErrors) {
  const Scene scene = sceneOf(R"(<sampler type="orthogonal"><integer name="seed" value="3"/>
      <boolean name="jitter" value="false"/><integer name="strength" value="2"/></sampler>)");
  EXPECT_EQ(scene.notes.size(), 1u) << "that of the sampler";
  expectSensorError(R"(<sampler type="independent"><integer name="sampleCount" value="64"/></sampler>)",
                    "unknown parameter \"sampleCount\" of sampler \"independent\"; expected sample_count");
}

}  // namespace
}  // namespace wavecrest
