// Colours. Expected values of spectra: what Mitsuba 3.9's scalar_rgb variant reports for the same XML.
#include "tests/load/scene_file.h"

namespace wavecrest {
namespace {

Rgb reflectanceOf(std::string_view element) {
  const Scene scene =
      loadBody("<shape type=\"sphere\"><bsdf type=\"diffuse\">" + std::string(element) + "</bsdf></shape>");
  return std::get<Diffuse>(scene.materials.at(0).kind).reflectance.value;
}

Rgb intensityOf(std::string_view element) {
  const Scene scene = loadBody("<emitter type=\"point\">" + std::string(element) + "</emitter>");
  return std::get<PointEmitter>(scene.emitters.at(0).kind).intensity;
}

void expectRgb(const Rgb& color, const Rgb& expected, double tolerance) {
  for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(color[i], expected[i], tolerance) << "channel " << i;
}

constexpr double kPrinted = 6e-6;  // Mitsuba computes in single precision and prints six digits

TEST(Color, RgbOfThree) {
  expectRgb(reflectanceOf(R"(<rgb name="reflectance" value="0.1, 0.2 0.3"/>)"), {0.1, 0.2, 0.3}, 0);
}

TEST(Color, RgbOfOneIsGrey) {
  expectRgb(reflectanceOf(R"(<rgb name="reflectance" value="0.25"/>)"), {0.25, 0.25, 0.25}, 0);
}

TEST(Color, FloatIsGrey) {
  expectRgb(reflectanceOf(R"(<float name="reflectance" value="0.25"/>)"), {0.25, 0.25, 0.25}, 0);
}

TEST(Color, WhereANumberIsAskedForIsItsMean) {
  const Scene scene = loadBody(R"(<shape type="sphere"><bsdf type="mask"><rgb name="opacity" value="0.3, 0.6, 0"/>
      <bsdf type="diffuse"/></bsdf></shape>)");
  EXPECT_NEAR(scene.materials.at(0).opacity->value, 0.3, 1e-15);
}

TEST(Color, SrgbHexIsDecoded) {
  // IEC 61966-2-1: 0x80 / 255 = 0.50196 decodes to 0.215861, below 0.04045 the curve is v / 12.92.
  expectRgb(reflectanceOf(R"(<srgb name="reflectance" value="#FF8005"/>)"), {1, 0.2158605, 5 / 255.0 / 12.92}, 1e-7);
}

TEST(Color, RgbHexIsDecodedButInOldFiles) {
  const auto colorOf = [](const std::string& tag, std::string_view version) {
    const Scene scene =
        load(sceneXml("<shape type=\"sphere\"><bsdf type=\"diffuse\"><" + tag +
                          " name=\"reflectance\" value=\"#FF8005\"/></bsdf></shape>" + std::string(kSensor),
                      version));
    return std::get<Diffuse>(scene.materials.at(0).kind).reflectance.value;
  };
  const Rgb decoded{1, 0.2158605, 5 / 255.0 / 12.92};
  expectRgb(colorOf("rgb", "3.0.0"), decoded, 1e-7);
  expectRgb(colorOf("rgb", "0.6.0"), {1, 128 / 255.0, 5 / 255.0}, 0);
  expectRgb(colorOf("srgb", "0.6.0"), decoded, 1e-7);
}

TEST(Color, SrgbNumbersAreDecoded) {
  expectRgb(reflectanceOf(R"(<srgb name="reflectance" value="0.5"/>)"), {0.2140411, 0.2140411, 0.2140411}, 1e-7);
}

TEST(Color, UniformSpectrumAsReflectanceIsGrey) {
  expectRgb(reflectanceOf(R"(<spectrum name="reflectance" value="0.3"/>)"), {0.3, 0.3, 0.3}, 0);
}

TEST(Color, UniformSpectrumAsEmissionHasTheColourOfIlluminantE) {
  expectRgb(intensityOf(R"(<spectrum name="intensity" value="2"/>)"), {2.40959, 1.89658, 1.81783}, kPrinted);
}

TEST(Color, UniformSpectrumOfOldFilesIsGrey) {
  for (const char* version : {"0.5.0", "0.6.0"}) {
    const Scene scene = load(sceneXml(R"(<emitter type="point"><spectrum name="intensity" value="2"/></emitter>)" +
                                          std::string(kSensor) + std::string(kSphere),
                                      version));
    expectRgb(std::get<PointEmitter>(scene.emitters.at(0).kind).intensity, {2, 2, 2}, 0);
  }
}

TEST(Color, SpectraAreTheSameInAllForms) {
  const Rgb pairs = intensityOf(R"(<spectrum name="intensity" value="400:0.1, 500:0.5, 600:0.8, 700:0.2"/>)");
  expectRgb(pairs, {0.858937, 0.620227, 0.236591}, kPrinted);
  expectRgb(intensityOf(R"(<spectrum name="intensity" type="irregular">
      <string name="wavelengths" value="400, 500, 600, 700"/><string name="values" value="0.1, 0.5, 0.8, 0.2"/>
      </spectrum>)"),
            pairs, 0);
  expectRgb(intensityOf(R"(<spectrum name="intensity" type="regular"><float name="wavelength_min" value="400"/>
      <float name="wavelength_max" value="700"/><string name="values" value="0.1, 0.5, 0.8, 0.2"/></spectrum>)"),
            pairs, 1e-15);
  const Folder folder;
  folder.write("lamp.spd", "# nm, W\n400 0.1\n500 0.5 # green\n\n600 0.8\n700 0.2");
  const Scene scene =
      loadBody(folder, R"(<emitter type="point"><spectrum name="intensity" filename="lamp.spd"/></emitter>)");
  expectRgb(std::get<PointEmitter>(scene.emitters.at(0).kind).intensity, pairs, 0);
}

// Mitsuba 3.9, scalar_rgb, from pairs of Planck's law every nm.
TEST(Color, BlackbodiesHavePlancksRadiance) {
  const Rgb expected{733.1098, 349.5687, 112.7105};
  constexpr double kTolerance = 0.003;  // of the quadratures, 1e-5 of the values
  expectRgb(intensityOf(R"(<spectrum name="intensity" type="blackbody"><float name="temperature" value="3000"/>
      </spectrum>)"),
            expected, kTolerance);
  const Scene scene =
      load(sceneXml(R"(<emitter type="point"><blackbody name="intensity" temperature="3000K" scale="1"/></emitter>)" +
                        std::string(kSensor) + std::string(kSphere),
                    "0.6.0"));
  expectRgb(std::get<PointEmitter>(scene.emitters.at(0).kind).intensity, expected, kTolerance);
}

TEST(Color, TabulatedSpectrumAsReflectanceIsSeenUnderD65) {
  expectRgb(reflectanceOf(R"(<spectrum name="reflectance" value="400:0.1, 500:0.3, 600:0.9, 700:0.5"/>)"),
            {0.950523, 0.558094, 0.154806}, kPrinted);
}

// Mitsuba 0.6 divides the integral of the spectrum and the observer by that of y, without an illuminant (rgb build).
TEST(Color, TabulatedSpectraOfOldFilesHaveNoIlluminant) {
  const Scene scene = load(sceneXml(R"(<shape type="sphere"><bsdf type="diffuse">
      <spectrum name="reflectance" value="400:0.5, 700:0.5"/></bsdf></shape>
    <shape type="sphere"><bsdf type="conductor"><spectrum name="eta" value="400:2, 700:2"/>
      <string name="extEta" value="vacuum"/></bsdf></shape>)" +
                                        std::string(kSensor),
                                    "0.6.0"));
  constexpr double kQuadrature = 2e-4;  // relative error of 1000 samples
  const Rgb flat{0.599872, 0.474748, 0.451799};
  expectRgb(std::get<Diffuse>(scene.materials.at(0).kind).reflectance.value, flat, kQuadrature);
  const Rgb eta = std::get<Conductor>(scene.materials.at(1).kind).eta;
  for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(eta[i], 4 * flat[i], 4 * kQuadrature) << "channel " << i;
}

// Mitsuba 0.6 reads it where it renders spectra.
TEST(Color, IntentOfOldFilesHasNoEffect) {
  const std::string body =
      R"(<emitter type="point"><spectrum name="intensity" intent="reflectance" value="2"/></emitter>
    <shape type="sphere"><bsdf type="diffuse"><rgb name="reflectance" intent="illuminant" value="0.1, 0.2, 0.3"/></bsdf>
    </shape>)" +
      std::string(kSensor);
  const Scene scene = load(sceneXml(body, "0.6.0"));
  expectRgb(std::get<PointEmitter>(scene.emitters.at(0).kind).intensity, {2, 2, 2}, 0);
  expectRgb(std::get<Diffuse>(scene.materials.at(0).kind).reflectance.value, {0.1, 0.2, 0.3}, 0);
  expectError(sceneXml(body), 2, "unexpected attribute \"intent\"");
}

TEST(Color, TabulatedSpectrumAsEmissionIsIntegratedAsItIs) {
  expectRgb(intensityOf(R"(<spectrum name="intensity" value="400:0.1, 500:0.3, 600:0.9, 700:0.5"/>)"),
            {1.09588, 0.537125, 0.131576}, kPrinted);
}

TEST(Color, TabulatedSpectrumAsIndexOfRefractionIsNotClamped) {
  const Scene scene = loadBody(R"(<shape type="sphere"><bsdf type="conductor">
      <spectrum name="eta" value="400:1.1, 500:2.3, 600:3.9, 700:0.5"/><spectrum name="k" value="400:1, 700:1"/>
    </bsdf></shape>)");
  expectRgb(std::get<Conductor>(scene.materials.at(0).kind).eta, {3.51945, 3.05049, 1.56694}, 2 * kPrinted);
  expectRgb(std::get<Conductor>(scene.materials.at(0).kind).k, {0.995342, 0.999756, 0.994909}, kPrinted);
}

TEST(Color, SpectrumObjectsOfD65AndUniformAreWhite) {
  expectRgb(intensityOf(R"(<spectrum type="d65" name="intensity"><float name="scale" value="2"/></spectrum>)"),
            {2, 2, 2}, 0);
  expectRgb(intensityOf(R"(<spectrum type="uniform" name="intensity"><float name="value" value="2"/></spectrum>)"),
            {2, 2, 2}, 0);
}

void expectColorError(std::string_view element, std::string_view text) {
  expectErrorOnLine2("<shape type=\"sphere\"><bsdf type=\"diffuse\">" + std::string(element) + "</bsdf></shape>", text);
}

TEST(Color, BadOnesAreErrors) {
  expectColorError(R"(<rgb name="reflectance" value="0.1 0.2"/>)", "2 numbers in <rgb>");
  expectColorError(R"(<rgb name="reflectance"/>)", "no value");
  expectColorError(R"(<rgb name="reflectance" value="1.5, 0, 0"/>)", "out of range; expected values from 0 to 1");
  expectColorError(R"(<rgb name="reflectance" value="-0.1"/>)", "out of range");
  expectColorError(R"(<srgb name="reflectance" value="#12345"/>)", "expected #rrggbb");
  expectColorError(R"(<spectrum name="reflectance" value="400:1"/>)", "too few entries");
  expectColorError(R"(<spectrum name="reflectance" value="400:1, 300:1"/>)", "do not increase");
  expectColorError(R"(<spectrum name="reflectance" value="400:1, 500"/>)", "expected wavelength:value");
  expectColorError(R"(<string name="reflectance" value="red"/>)", "<string> given for a colour");
  expectColorError(R"(<spectrum name="reflectance" type="volume"/>)", "not supported");
  expectColorError(
      R"(<spectrum name="reflectance" type="blackbody"><float name="temperature" value="3000"/></spectrum>)",
      "for what does not emit");
  expectColorError(R"(<spectrum name="reflectance" type="irregular"><string name="wavelengths" value="400 500 600"/>
                      <string name="values" value="1 0"/></spectrum>)",
                   "3 wavelengths and 2 values");
}

TEST(Color, SpectrumThatContainsItselfIsAnError) {
  for (const char* type : {"srgb", "d65"}) {
    expectColorError("<spectrum type=\"" + std::string(type) +
                         R"(" id="a" name="reflectance"><ref id="a" name="color"/></spectrum>)",
                     "<spectrum> contains itself through a reference");
  }
}

TEST(Color, ReflectanceOfAnObjectMayBeAbove1) {
  expectRgb(
      reflectanceOf(R"(<spectrum type="uniform" name="reflectance"><float name="value" value="1.5"/></spectrum>)"),
      {1.5, 1.5, 1.5}, 0);
}

TEST(Color, AllFormsAreInTheRangeOfPositiveFloats) {
  expectColorError(R"(<spectrum type="uniform" name="reflectance"><float name="value" value="-3"/></spectrum>)",
                   "colour of a <spectrum> is out of range; expected values from 0 to 3.4e38");
  for (const char* intensity :
       {R"(<spectrum type="d65" name="intensity"><float name="scale" value="-1"/></spectrum>)",
        R"(<spectrum type="blackbody" name="intensity"><float name="temperature" value="1e300"/></spectrum>)",
        R"(<blackbody name="intensity" temperature="3000" scale="-1"/>)",
        R"(<rgb name="intensity" value="0, 1e39, 0"/>)", R"(<float name="intensity" value="1e39"/>)"}) {
    expectErrorOnLine2("<emitter type=\"point\">" + std::string(intensity) + "</emitter>", "out of range");
  }
  expectRgb(intensityOf(R"(<rgb name="intensity" value="3.4e38, 0, 0"/>)"), {3.4e38, 0, 0}, 0);
}

TEST(Color, NegativeRadianceIsAnError) {
  expectErrorOnLine2(R"(<emitter type="constant"><rgb name="radiance" value="1,-1,1"/></emitter>)", "out of range");
}

}  // namespace
}  // namespace wavecrest
