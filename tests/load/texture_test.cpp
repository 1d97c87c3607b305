// Textures: the colour treatment of image files, and the options of a bitmap. Formats of files: bitmap_format_test.cpp.
#include <cmath>
#include <cstdlib>

#include "metrics/image/image_io.h"
#include "tests/load/bitmap_scene.h"
#include "tests/load/mesh_text.h"
#include "tests/load/scene_file.h"

namespace wavecrest {
namespace {

// A folder with one image of a single pixel, code 128 of 255.
class ImageFolder : public Folder {
 public:
  ImageFolder() {
    writePng((path() / "grey.png").string(), Image8{.width = 1, .height = 1, .pixels = {128, 128, 128}});
  }
};

TEST(Bitmap, EightBitIsDecodedFromSrgb) {
  EXPECT_NEAR(bitmapOf(ImageFolder(), "grey.png").bitmap->pixels[0], 0.21586050, 1e-7);
}

TEST(Bitmap, RawIsNotDecoded) {
  EXPECT_FLOAT_EQ(bitmapOf(ImageFolder(), "grey.png", R"(<boolean name="raw" value="true"/>)").bitmap->pixels[0],
                  128 / 255.0f);
}

TEST(Bitmap, ExrIsTakenAsItIs) {
  const Folder folder;
  writeExr((folder.path() / "a.exr").string(), {.width = 1, .height = 1, .channels = 3, .pixels = {0.5f, 2, 0.25f}});
  EXPECT_EQ(bitmapOf(folder, "a.exr").bitmap->pixels, (std::vector<float>{0.5f, 2, 0.25f}));
}

// A surface cannot take light that is not there; more than arrives it may reflect, as in Mitsuba, but not in silence.
TEST(Bitmap, ReflectanceBelowZeroIsRefusedAndAboveOneIsSaid) {
  const auto reflectance = [](float value) {
    const Folder folder;
    writeExr((folder.path() / "a.exr").string(),
             {.width = 1, .height = 1, .channels = 3, .pixels = {0.5f, value, 0.25f}});
    return loadBody(folder, texturedSphere(R"(<texture name="reflectance" type="bitmap">
                                        <string name="filename" value="a.exr"/></texture>)"));
  };
  EXPECT_TRUE(reflectance(1).warnings.empty());
  ASSERT_EQ(reflectance(5).warnings.size(), 1u);
  EXPECT_NE(reflectance(5).warnings[0].find("up to 5"), std::string::npos);
  EXPECT_THROW(reflectance(-1), LoadError);
}

TEST(Bitmap, FormatFollowsFromTheContent) {
  const Folder folder;
  writeExr((folder.path() / "a.png").string(), {.width = 1, .height = 1, .channels = 3, .pixels = {0.5f, 1, 0.25f}});
  EXPECT_EQ(bitmapOf(folder, "a.png").bitmap->pixels, (std::vector<float>{0.5f, 1, 0.25f}));
  writePng((folder.path() / "b").string(), Image8{.width = 1, .height = 1, .pixels = {255, 0, 0}});
  EXPECT_EQ(bitmapOf(folder, "b").bitmap->pixels, (std::vector<float>{1, 0, 0}));
}

Scene sceneOfFile(const Folder& folder, std::string_view file) {
  return loadBody(folder,
                  texturedSphere("<texture name=\"reflectance\" type=\"bitmap\"><string name=\"filename\" value=\"" +
                                 std::string(file) + "\"/></texture>"));
}

TEST(Bitmap, ExposureOfARadiancePictureIsLeftOut) {
  const Folder folder;
  for (const char* line :
       {"EXPOSURE=2", "EXPOSURE=0", "EXPOSURE=nonsense", "COLORCORR=1 2 1", "PRIMARIES=1 0 0 1 0 0 1 1"}) {
    folder.write("a.hdr", "#?RGBE\n" + std::string(line) + "\n\n-Y 1 +X 1\n" + std::string("\x40\x20\0\x82", 4));
    const Scene scene = sceneOfFile(folder, "a.hdr");
    EXPECT_EQ(std::get<BitmapTexture>(scene.textures.at(0).kind).bitmap->pixels, (std::vector<float>{1, 0.5f, 0}));
    ASSERT_EQ(scene.notes.size(), 1u);
    EXPECT_EQ(scene.notes[0].what, "EXPOSURE, COLORCORR or PRIMARIES of a Radiance picture");
  }
}

TEST(Bitmap, WhatIsNotFiniteIsBlackAndCounted) {
  const Folder folder;
  writeExr((folder.path() / "a.exr").string(),
           {.width = 1, .height = 1, .channels = 3, .pixels = {0.5f, NAN, INFINITY}});
  const Scene scene = sceneOfFile(folder, "a.exr");
  EXPECT_EQ(std::get<BitmapTexture>(scene.textures.at(0).kind).bitmap->pixels, (std::vector<float>{0.5f, 0, 0}));
  ASSERT_EQ(scene.notes.size(), 1u);
  EXPECT_EQ(scene.notes[0].what, "values in \"a.exr\" that are not finite: 2");
}

TEST(Bitmap, TopRowComesFirst) {
  const Folder folder;
  writePng((folder.path() / "two.png").string(), Image8{.width = 1, .height = 2, .pixels = {255, 255, 255, 0, 0, 0}});
  EXPECT_EQ(bitmapOf(folder, "two.png").bitmap->pixels, (std::vector<float>{1, 1, 1, 0, 0, 0}));
}

TEST(Bitmap, Defaults) {
  const BitmapTexture texture = bitmapOf(ImageFolder(), "grey.png");
  EXPECT_EQ(texture.filter, Filter::bilinear);
  EXPECT_EQ(texture.wrap, Wrap::repeat);
}

TEST(Bitmap, FilterAndWrap) {
  const BitmapTexture texture =
      bitmapOf(ImageFolder(), "grey.png",
               R"(<string name="filter_type" value="nearest"/><string name="wrap_mode" value="mirror"/>)");
  EXPECT_EQ(texture.filter, Filter::nearest);
  EXPECT_EQ(texture.wrap, Wrap::mirror);
}

TEST(Bitmap, SameFileIsReadOnce) {
  const ImageFolder folder;
  const Scene scene = loadBody(folder, R"(
    <shape type="sphere"><bsdf type="diffuse"><texture name="reflectance" type="bitmap"><string name="filename" value="grey.png"/></texture></bsdf></shape>
    <shape type="cube"><bsdf type="diffuse"><texture name="reflectance" type="bitmap"><string name="filename" value="grey.png"/></texture></bsdf></shape>)");
  ASSERT_EQ(scene.textures.size(), 2u);
  EXPECT_EQ(std::get<BitmapTexture>(scene.textures[0].kind).bitmap,
            std::get<BitmapTexture>(scene.textures[1].kind).bitmap);
}

TEST(Bitmap, IsFoundBesideTheFileThatNamesIt) {
  const Folder folder;
  std::filesystem::create_directories(folder.path() / "sub");
  writePng((folder.path() / "sub/grey.png").string(), Image8{.width = 1, .height = 1, .pixels = {9, 9, 9}});
  folder.write(
      "sub/part.xml",
      sceneXml(texturedSphere(
          R"(<texture name="reflectance" type="bitmap"><string name="filename" value="grey.png"/></texture>)")));
  EXPECT_EQ(load(folder, sceneXml(std::string(kSensor) + R"(<include filename="sub/part.xml"/>)")).textures.size(), 1u);
}

TEST(Bitmap, IsFoundInASearchPath) {
  const Folder folder;
  std::filesystem::create_directories(folder.path() / "images");
  writePng((folder.path() / "images/grey.png").string(), Image8{.width = 1, .height = 1, .pixels = {9, 9, 9}});
  const std::string body = texturedSphere(
      R"(<texture name="reflectance" type="bitmap"><string name="filename" value="grey.png"/></texture>)");
  EXPECT_EQ(loadBody(folder, R"(<path value="images"/>)" + body).textures.size(), 1u);
}

TEST(Bitmap, LastSearchPathComesFirstAndTheScenesFolderLast) {
  const Folder folder;
  uint32_t width = 0;
  for (const char* place : {".", "a", "b"}) {
    std::filesystem::create_directories(folder.path() / place);
    ++width;
    writePng((folder.path() / place / "grey.png").string(),
             Image8{.width = width, .height = 1, .pixels = std::vector<uint8_t>(size_t{3} * width, 9)});
  }
  const auto widthWith = [&](const std::string& paths) {
    const Scene scene = loadBody(
        folder,
        paths +
            texturedSphere(
                R"(<texture name="reflectance" type="bitmap"><string name="filename" value="grey.png"/></texture>)"));
    return std::get<BitmapTexture>(scene.textures.at(0).kind).bitmap->width;
  };
  EXPECT_EQ(widthWith(""), 1u);
  EXPECT_EQ(widthWith(R"(<path value="a"/>)"), 2u);
  EXPECT_EQ(widthWith(R"(<path value="a"/><path value="b"/>)"), 3u);
}

TEST(Bitmap, MistakesAreErrorsWhereTheFileIsNamed) {
  const ImageFolder folder;
  folder.write("broken.png", "\x89PNG nonsense");
  folder.write("broken.jpg", "\xff\xd8\xff nonsense");
  folder.write("note.txt", "text");
  const auto file = [](std::string_view name) {
    return "<string name=\"filename\" value=\"" + std::string(name) + "\"/>";
  };
  expectTextureError(folder, "", "has no \"filename\"");
  expectTextureError(folder, file("none.png"), "not found");
  expectTextureError(folder, file("none.jpg"), "not found");
  expectTextureError(folder, file("broken.png"), "broken.png");
  expectTextureError(folder, file("broken.jpg"), "damaged JPEG");
  expectTextureError(folder, file("note.txt"),
                     "unknown image format '.txt'; expected EXR, PFM, HDR, PNG, JPEG, BMP or TGA");
  expectTextureError(folder, file("grey.png") + R"(<string name="wrap_mode" value="bend"/>)", "unknown wrap_mode");
  expectTextureError(folder, file("grey.png") + R"(<string name="filter_type" value="cubic"/>)",
                     "unknown filter_type \"cubic\"");
  expectTextureError(folder, file("grey.png") + R"(<string name="channel" value="a"/>)", "channel \"a\"");
  expectTextureError(folder, file("grey.png") + R"(<string name="wrap_mode_u" value="clamp"/>)", "differ");
}

TEST(Bitmap, OptionsOfVersion06) {
  const BitmapTexture texture = bitmapOf(ImageFolder(), "grey.png", R"(<string name="wrap_mode_u" value="clamp"/>
      <string name="wrap_mode_v" value="clamp"/><float name="gamma" value="1"/><string name="channel" value="g"/>)");
  EXPECT_EQ(texture.wrap, Wrap::clamp);
  EXPECT_EQ(texture.bitmap->channels, 1u);
  EXPECT_FLOAT_EQ(texture.bitmap->pixels.at(0), 128 / 255.0f);
}

TEST(Bitmap, BordersOfOneColourAreClampedWithANote) {
  const ImageFolder folder;
  for (const std::string mode : {"zero", "black", "one", "white"}) {
    const Scene scene = loadBody(folder, texturedSphere(R"(<texture name="reflectance" type="bitmap">
        <string name="filename" value="grey.png"/><string name="wrap_mode" value=")" +
                                                        mode + "\"/></texture>"));
    EXPECT_EQ(std::get<BitmapTexture>(scene.textures.at(0).kind).wrap, Wrap::clamp) << mode;
    ASSERT_EQ(scene.notes.size(), 1u) << mode;
    EXPECT_EQ(scene.notes[0].what, "wrap_mode \"" + mode + "\"");
  }
}

// 0 leaves the curve to the file, 1 stands for none, and -1 for that of sRGB.
TEST(Bitmap, GammasOfAnotherCurveThanThatOfTheFileAreNoted) {
  const ImageFolder folder;
  writeExr((folder.path() / "grey.exr").string(),
           {.width = 1, .height = 1, .channels = 3, .pixels = {0.5f, 0.5f, 0.5f}});
  const auto noted = [&](const std::string& file, const std::string& gamma) {
    const std::vector<Note> notes =
        sceneWithBitmap(folder, file, R"(<float name="gamma" value=")" + gamma + "\"/>").notes;
    for (const Note& note : notes) {
      EXPECT_EQ(note.what, "gamma of a bitmap");
      EXPECT_EQ(note.effect, "left out: 8- and 16-bit files have the sRGB curve, others none");
    }
    return notes.size();
  };
  EXPECT_EQ(noted("grey.exr", "2.2"), 1u);
  EXPECT_EQ(noted("grey.exr", "-1"), 1u);
  EXPECT_EQ(noted("grey.exr", "0"), 0u);
  EXPECT_EQ(noted("grey.exr", "1"), 0u);
  EXPECT_EQ(noted("grey.png", "2.2"), 1u);
  EXPECT_EQ(noted("grey.png", "-1"), 0u);
  EXPECT_EQ(noted("grey.png", "0"), 0u);
}

// One grey pixel, with a gAMA chunk in place of the chunk sRGB. gamma: times 100000.
std::string pngOfGamma(uint32_t gamma) {
  const uint8_t grey[] = {128, 128, 128};
  const std::vector<unsigned char> bytes = encodePng("grey.png", 1, 1, grey);
  std::string png(bytes.begin(), bytes.end()), chunk = "gAMA", length;
  appendValue<uint32_t>(chunk, gamma, true);
  const uLong check = crc32(0, reinterpret_cast<const Bytef*>(chunk.data()), static_cast<uInt>(chunk.size()));
  appendValue<uint32_t>(chunk, static_cast<uint32_t>(check), true);
  appendValue<uint32_t>(length, 4, true);
  // Of the other chunk: length, name, one byte, and the check.
  return png.replace(png.find("sRGB") - 4, 13, length + chunk);
}

TEST(Bitmap, TheGammaOfAPngIsNotedUnlessItIsThatOfSrgb) {
  const Folder folder;
  folder.write("linear.png", pngOfGamma(100000));
  folder.write("srgb.png", pngOfGamma(45455));
  const std::vector<Note> notes = sceneWithBitmap(folder, "linear.png", "").notes;
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(notes[0].what, "gAMA of a PNG");
  EXPECT_TRUE(sceneWithBitmap(folder, "linear.png", R"(<boolean name="raw" value="true"/>)").notes.empty());
  EXPECT_TRUE(sceneWithBitmap(folder, "srgb.png", "").notes.empty());
  EXPECT_TRUE(sceneWithBitmap(ImageFolder(), "grey.png", "").notes.empty());
}

TEST(Bitmap, WrapModeIsThatOfAnAxisWithoutItsOwn) {
  const ImageFolder folder;
  const std::string clamp = R"(<string name="wrap_mode" value="clamp"/>)";
  EXPECT_EQ(bitmapOf(folder, "grey.png", clamp + R"(<string name="wrap_mode_u" value="clamp"/>)").wrap, Wrap::clamp);
  expectTextureError(
      folder,
      R"(<string name="filename" value="grey.png"/>)" + clamp + R"(<string name="wrap_mode_u" value="repeat"/>)",
      "differ");
}

TEST(ScaleTexture, MultipliesTheOneWithin) {
  const ImageFolder folder;
  const Scene scene =
      loadBody(folder, texturedSphere(R"(<texture name="reflectance" type="scale"><float name="scale" value="0.5"/>
      <texture type="bitmap"><string name="filename" value="grey.png"/><boolean name="raw" value="true"/></texture>
      </texture>)"));
  ASSERT_EQ(scene.textures.size(), 1u);
  EXPECT_FLOAT_EQ(std::get<BitmapTexture>(scene.textures[0].kind).bitmap->pixels[0], 64 / 255.0f);
}

TEST(ScaleTexture, ScalesWhatIsNamedValue) {
  const auto textureOf = [](const std::string& value) {
    return loadBody(texturedSphere(R"(<texture name="reflectance" type="scale"><float name="scale" value="0.5"/>)" +
                                   value + "</texture>"))
        .textures.at(0);
  };
  const Texture board = textureOf(R"(<texture name="value" type="checkerboard"/>)");
  EXPECT_EQ(std::get<CheckerboardTexture>(board.kind).color0, (Rgb{0.2, 0.2, 0.2}));
  const Texture color = textureOf(R"(<rgb name="value" value="0.5, 0.25, 1"/>)");
  EXPECT_EQ(std::get<BitmapTexture>(color.kind).bitmap->pixels, (std::vector<float>{0.25f, 0.125f, 0.5f}));
}

TEST(ScaleTexture, ProductThatNoFloatHoldsIsAnError) {
  const std::string value = R"(<float name="scale" value="3e38"/><rgb name="value" value="9"/>)";
  expectErrorOnLine2(R"(<shape type="sphere"><emitter type="area"><texture name="radiance" type="scale">)" + value +
                         "</texture></emitter></shape>",
                     "emission texture has a value of inf");
}

TEST(ScaleTexture, NeedsOneThingToScale) {
  const auto scaled = [](const std::string& content) {
    return texturedSphere("<texture name=\"reflectance\" type=\"scale\">" + content + "</texture>");
  };
  expectErrorOnLine2(scaled(""), "contains 0 objects <texture>");
  expectErrorOnLine2(scaled(R"(<rgb name="value" value="0.5"/><texture type="checkerboard"/>)"),
                     "unknown object <texture>");
}

// As a number, except for heights, Mitsuba 0.6 takes the mean of the channels.
TEST(Bitmap, OfColoursIsANumberByItsLuminanceOrInOldFilesItsMean) {
  const Folder folder;
  writeExr((folder.path() / "green.exr").string(), {.width = 1, .height = 1, .channels = 3, .pixels = {0, 1, 0}});
  const auto numberOf = [&](const std::string& type, const std::string& parts, std::string_view version,
                            const auto& textureIn) {
    const Scene scene =
        load(folder, sceneXml("<shape type=\"sphere\"><bsdf type=\"" + type + R"("><texture type="bitmap" name="weight">
          <string name="filename" value="green.exr"/></texture>)" +
                                  parts + "</bsdf></shape>" + std::string(kSensor),
                              version));
    const uint32_t texture = textureIn(scene.materials.at(scene.shapes.at(0).material));
    const Bitmap& bitmap = *std::get<BitmapTexture>(scene.textures.at(texture).kind).bitmap;
    EXPECT_EQ(bitmap.channels, 1u);
    return bitmap.pixels.at(0);
  };
  const std::string diffuse = R"(<bsdf type="diffuse"/>)";
  const auto weight = [](const Material& material) { return std::get<Blend>(material.kind).weightTexture; };
  const auto height = [](const Material& material) { return material.bumpTexture; };
  EXPECT_FLOAT_EQ(numberOf("blendbsdf", diffuse + diffuse, "3.0.0", weight), 0.71516f);
  EXPECT_FLOAT_EQ(numberOf("blendbsdf", diffuse + diffuse, "0.6.0", weight), 1 / 3.0f);
  EXPECT_FLOAT_EQ(numberOf("bumpmap", diffuse, "0.6.0", height), 0.71516f);
}

TEST(Bitmap, ChannelOfAlphaIs1WithLenient) {
  const Folder folder;
  writePng((folder.path() / "red.png").string(), Image8{.width = 1, .height = 1, .pixels = {255, 0, 0}});
  const std::string sphere = texturedSphere(R"(<texture name="reflectance" type="bitmap">
      <string name="filename" value="red.png"/><string name="channel" value="a"/></texture>)");
  const Scene scene = loadBody(folder, sphere, {.lenient = true});
  EXPECT_EQ(std::get<BitmapTexture>(scene.textures.at(0).kind).bitmap->pixels, (std::vector<float>{1}));
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_NE(scene.warnings[0].find("(replaced by 1)"), std::string::npos) << scene.warnings[0];
  EXPECT_THROW(loadBody(folder, sphere), LoadError);
}

}  // namespace
}  // namespace wavecrest
