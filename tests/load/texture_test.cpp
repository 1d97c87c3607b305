// Textures: image files of each kind, their colour treatment, and the options of a bitmap.
#include <cmath>
#include <cstdlib>

#include "metrics/image/image_io.h"
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

BitmapTexture bitmapOf(const Folder& folder, const std::string& file, std::string_view options = "") {
  const Scene scene = loadBody(
      folder, texturedSphere("<texture name=\"reflectance\" type=\"bitmap\"><string name=\"filename\" value=\"" + file +
                             "\"/>" + std::string(options) + "</texture>"));
  return std::get<BitmapTexture>(scene.textures.at(0).kind);
}

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

TEST(Bitmap, JpegIsDecodedFromSrgb) {
  const BitmapTexture texture = bitmapOf(Folder(), std::string(WAVECREST_TEST_DATA) + "/halves.jpg");
  const Bitmap& bitmap = *texture.bitmap;
  ASSERT_EQ(bitmap.width, 32u);
  ASSERT_EQ(bitmap.height, 16u);
  // Left half red, right half mid grey (code 128); JPEG is lossy, two codes either way.
  const float* left = &bitmap.pixels[3 * (8 * 32 + 4)];
  const float* right = &bitmap.pixels[3 * (8 * 32 + 28)];
  EXPECT_NEAR(left[0], 1, 0.02);
  EXPECT_NEAR(left[1], 0, 0.01);
  EXPECT_NEAR(right[0], 0.21586, 0.008);
  EXPECT_NEAR(right[2], 0.21586, 0.008);
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

void expectTextureError(const Folder& folder, std::string_view content, std::string_view text) {
  expectError(
      folder,
      sceneXml("\n" +
               texturedSphere("<texture name=\"reflectance\" type=\"bitmap\">" + std::string(content) + "</texture>") +
               std::string(kSensor)),
      2, text);
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

std::string withByte(std::string bytes, size_t at, int value) {
  bytes[at] = static_cast<char>(value);
  return bytes;
}

// Two pixels, red over blue, as files of each layout. Rows of a BMP fill four bytes.
std::string bmpOf(bool palette, bool topFirst) {
  std::string bytes = "BM";
  const auto word = [&](uint32_t value) { appendValue<uint32_t>(bytes, value, false); };
  for (const uint32_t value : {70u, 0u, palette ? 62u : 54u, 40u, 1u}) word(value);
  word(topFirst ? static_cast<uint32_t>(-2) : 2u);
  appendValue<uint16_t>(bytes, 1, false);
  appendValue<uint16_t>(bytes, palette ? 8 : 24, false);
  for (const uint32_t value : {0u, 8u, 0u, 0u, 2u, 0u}) word(value);
  const std::string red("\0\0\xff\0", 4), blue("\xff\0\0\0", 4);
  if (palette) return bytes + red + blue + std::string(topFirst ? "\0\0\0\0\1\0\0\0" : "\1\0\0\0\0\0\0\0", 8);
  return bytes + (topFirst ? red + blue : blue + red);
}
// One pixel in a row of four bytes. masks: of red, green and blue, in a V5 header. Without masks the header has 40
// bytes.
std::string bmpOfPixel(uint16_t bits, std::string_view row, const std::vector<uint32_t>& masks = {}) {
  const uint32_t header = masks.empty() ? 40u : 124u;
  std::string bytes = "BM";
  const auto word = [&](uint32_t value) { appendValue<uint32_t>(bytes, value, false); };
  for (const uint32_t value : {14 + header + 4, 0u, 14 + header, header, 1u, 1u}) word(value);
  appendValue<uint16_t>(bytes, 1, false);
  appendValue<uint16_t>(bytes, bits, false);
  for (const uint32_t value : {masks.empty() ? 0u : 3u, 4u, 0u, 0u, 0u, 0u}) word(value);
  for (const uint32_t mask : masks) word(mask);
  bytes.resize(14 + header, '\0');
  return bytes + std::string(row);
}
std::string tgaOf(bool runs, bool topFirst) {
  std::string bytes(18, '\0');
  bytes[2] = runs ? 10 : 2;
  bytes[12] = 1;
  bytes[14] = 2;
  bytes[16] = 24;
  bytes[17] = topFirst ? 0x20 : 0;
  const std::string red("\0\0\xff", 3), blue("\xff\0\0", 3), packet(runs ? "\0" : "", runs ? 1 : 0);
  return bytes + packet + (topFirst ? red : blue) + packet + (topFirst ? blue : red);
}
const std::vector<float> kRedOverBlue = {1, 0, 0, 0, 0, 1};

TEST(Bitmap, BmpOfEachLayout) {
  const Folder folder;
  for (const bool palette : {false, true}) {
    for (const bool topFirst : {false, true}) {
      folder.write("two.bmp", bmpOf(palette, topFirst));
      EXPECT_EQ(bitmapOf(folder, "two.bmp").bitmap->pixels, kRedOverBlue) << palette << topFirst;
    }
  }
}

TEST(Bitmap, MasksOfABmpSayWhereItsChannelsAre) {
  const Folder folder;
  const std::string cases[] = {
      bmpOfPixel(32, {"\0\0\xff\x80", 4}),
      bmpOfPixel(32, {"\0\0\xff\x80", 4}, {0xff0000, 0xff00, 0xff}),
      bmpOfPixel(32, {"\x80\0\0\xff", 4}, {0xff000000, 0xff0000, 0xff00}),
      bmpOfPixel(24, {"\xff\0\0\0", 4}, {0xff, 0xff00, 0xff0000}),
  };
  for (const std::string& bytes : cases) {
    folder.write("red.bmp", bytes);
    EXPECT_EQ(bitmapOf(folder, "red.bmp").bitmap->pixels, (std::vector<float>{1, 0, 0})) << (&bytes - cases);
  }
}

TEST(Bitmap, MasksOfABmpThatAreNotWholeBytesAreErrors) {
  const Folder folder;
  const std::string cases[] = {
      bmpOfPixel(32, {"\0\0\0\0", 4}, {0x7c00, 0x3e0, 0x1f}),
      bmpOfPixel(32, {"\0\0\0\0", 4}, {0xff0, 0xff00, 0xff}),
      bmpOfPixel(32, {"\0\0\0\0", 4}, {0xff0000, 0xff00, 0}),
      bmpOfPixel(24, {"\0\0\0\0", 4}, {0xff000000, 0xff00, 0xff}),
      withByte(bmpOf(false, false), 30, 3),  // ends inside the masks
  };
  for (const std::string& bytes : cases) {
    folder.write("masks.bmp", bytes);
    expectTextureError(folder, R"(<string name="filename" value="masks.bmp"/>)", "masks are not whole bytes");
  }
}

TEST(Bitmap, TgaOfEachLayout) {
  const Folder folder;
  for (const bool runs : {false, true}) {
    for (const bool topFirst : {false, true}) {
      folder.write("two.tga", tgaOf(runs, topFirst));
      EXPECT_EQ(bitmapOf(folder, "two.tga").bitmap->pixels, kRedOverBlue) << runs << topFirst;
    }
  }
}

TEST(Bitmap, TgaRunRepeatsItsColour) {
  std::string bytes = tgaOf(true, true).substr(0, 18);
  bytes += "\x81";
  bytes += std::string("\0\0\xff", 3);
  const Folder folder;
  folder.write("run.tga", bytes);
  EXPECT_EQ(bitmapOf(folder, "run.tga").bitmap->pixels, (std::vector<float>{1, 0, 0, 1, 0, 0}));
}

TEST(Bitmap, ColoursOutsideOfRec709KeepTheirNegativeChannels) {
  const Folder folder;
  const auto write = [&](std::vector<float> pixels) {
    writeExr((folder.path() / "wide.exr").string(),
             {.width = 2, .height = 1, .channels = 3, .pixels = std::move(pixels)});
  };
  write({-0.1f, 0.5f, 0.5f, 0, 0, 0});
  EXPECT_EQ(bitmapOf(folder, "wide.exr").bitmap->pixels[0], -0.1f);
  write({0.1f, -0.5f, 0.1f, 0, 0, 0});
  expectTextureError(folder, R"(<string name="filename" value="wide.exr"/>)",
                     "reflectance texture has a value of -0.5");
}

TEST(Bitmap, WhatATgaUnpacksToIsBounded) {
  std::string bytes = tgaOf(true, true).substr(0, 18);
  bytes[12] = 64;
  bytes += "\xff" + std::string("\0\0\xff", 3);  // 64 x 2 pixels are 1536 bytes as floats
  const Folder folder;
  folder.write("run.tga", bytes);
  EXPECT_EQ(bitmapOf(folder, "run.tga").bitmap->width, 64u);
  setenv(kImageLimitVariable, "1K", 1);
  expectTextureError(folder, R"(<string name="filename" value="run.tga"/>)", "unpacks to 64x2 pixels");
  unsetenv(kImageLimitVariable);
}

TEST(Bitmap, DamagedBmpAndTgaAreErrors) {
  const Folder folder;
  const std::string bmp = bmpOf(false, false), tga = tgaOf(false, false);
  const std::pair<std::string, std::string> cases[] = {
      {"a.bmp", bmp.substr(0, 60)},     {"b.bmp", "BM"},
      {"c.bmp", withByte(bmp, 28, 16)}, {"d.tga", tga.substr(0, 22)},
      {"e.tga", withByte(tga, 2, 7)},   {"f.tga", withByte(tga, 15, 127)}};
  for (const auto& [name, bytes] : cases) {
    folder.write(name, bytes);
    expectTextureError(folder, R"(<string name="filename" value=")" + name + "\"/>", name);
  }
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

// Of a file with a bitmap that has these options.
std::vector<Note> notesOf(const Folder& folder, const std::string& file, const std::string& options) {
  return loadBody(folder,
                  texturedSphere("<texture name=\"reflectance\" type=\"bitmap\"><string name=\"filename\" value=\"" +
                                 file + "\"/>" + options + "</texture>"))
      .notes;
}

// 0 leaves the curve to the file, 1 stands for none, and -1 for that of sRGB.
TEST(Bitmap, GammasOfAnotherCurveThanThatOfTheFileAreNoted) {
  const ImageFolder folder;
  writeExr((folder.path() / "grey.exr").string(),
           {.width = 1, .height = 1, .channels = 3, .pixels = {0.5f, 0.5f, 0.5f}});
  const auto noted = [&](const std::string& file, const std::string& gamma) {
    const std::vector<Note> notes = notesOf(folder, file, R"(<float name="gamma" value=")" + gamma + "\"/>");
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
  const std::vector<Note> notes = notesOf(folder, "linear.png", "");
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(notes[0].what, "gAMA of a PNG");
  EXPECT_TRUE(notesOf(folder, "linear.png", R"(<boolean name="raw" value="true"/>)").empty());
  EXPECT_TRUE(notesOf(folder, "srgb.png", "").empty());
  EXPECT_TRUE(notesOf(ImageFolder(), "grey.png", "").empty());
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

std::string halvesJpeg() {
  std::ifstream in(std::string(WAVECREST_TEST_DATA) + "/halves.jpg", std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Bitmap, TruncatedJpegIsAnError) {
  const std::string bytes = halvesJpeg();
  ASSERT_GT(bytes.size(), 300u);
  const Folder folder;
  folder.write("half.jpg", bytes.substr(0, bytes.size() - 40));
  expectTextureError(folder, R"(<string name="filename" value="half.jpg"/>)", "damaged JPEG");
}

// The frame header begins with a marker of two bytes, its length, and the precision. Height, width, the number of
// components and three bytes for each of them follow.
TEST(Bitmap, WhatAJpegUnpacksToIsBounded) {
  std::string bytes = halvesJpeg();
  const size_t frame = bytes.find(std::string("\xff\xc0\0\x11", 4));
  ASSERT_NE(frame, std::string::npos);
  bytes.replace(frame + 5, 4, "\x4e\x20\x4e\x20");  // 20000 in two bytes, twice
  const Folder folder;
  folder.write("large.jpg", bytes);
  expectTextureError(folder, R"(<string name="filename" value="large.jpg"/>)", "announces 20000 x 20000 pixels");
  folder.write("large.jpg", bytes + std::string(400'000, '\0'));
  expectTextureError(folder, R"(<string name="filename" value="large.jpg"/>)", "unpacks to 20000x20000 pixels");
}

TEST(Bitmap, JpegInCmykIsAnError) {
  std::string bytes = halvesJpeg();
  const size_t frame = bytes.find(std::string("\xff\xc0\0\x11", 4));
  ASSERT_NE(frame, std::string::npos);
  bytes[frame + 3] = 8 + 4 * 3;
  bytes[frame + 9] = 4;
  bytes.insert(frame + 19, "\4\x11\1");
  const Folder folder;
  folder.write("cmyk.jpg", bytes);
  expectTextureError(folder, R"(<string name="filename" value="cmyk.jpg"/>)", "JPEG in CMYK; expected grey or RGB");
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
