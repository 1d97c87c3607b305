// The scene as plain data: what the loader produces and what the engine compiles for its kernels.
//
// Everything is already in world space and in linear Rec.709 RGB; lengths are in scene units, angles in degrees where a
// name says so, IORs are absolute. Indices replace pointers, so a Scene can be copied, hashed and compared.
// The meaning of each field follows Mitsuba 3's plugin of the same name.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace wavecrest {

using Double3 = std::array<double, 3>;
using Float3 = std::array<float, 3>;
using Float2 = std::array<float, 2>;
using Rgb = std::array<double, 3>;
using Matrix4 = std::array<std::array<double, 4>, 4>;  // row-major, acts on column vectors

constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();

// Where something was read from, for error messages.
struct SourceLocation {
  std::string file;
  int line = 0;
};

// ---- textures -------------------------------------------------------------------------------------------------------

enum class Wrap { repeat, mirror, clamp };
enum class Filter { nearest, bilinear };

struct Bitmap {
  uint32_t width = 0, height = 0;
  uint32_t channels = 3;      // 1 or 3
  std::vector<float> pixels;  // row-major from the top row, linear
};

struct BitmapTexture {
  std::shared_ptr<const Bitmap> bitmap;
  Filter filter = Filter::bilinear;
  Wrap wrap = Wrap::repeat;
  bool ofMesh = false;  // an attribute of the one mesh that has it, baked (engine/load/mesh_attributes.h)
};

struct CheckerboardTexture {
  Rgb color0{0.4, 0.4, 0.4}, color1{0.2, 0.2, 0.2};
};

struct Texture {
  std::variant<BitmapTexture, CheckerboardTexture> kind;
  Matrix4 toUv{};  // affine map of (u, v, 0, 1); a bitmap's top left corner is at (0, 0), its bottom right at (1, 1)
};

// A value that is constant or looked up in scene.textures.
struct TexturedRgb {
  Rgb value{0, 0, 0};
  uint32_t texture = kNone;
};
struct TexturedFloat {
  double value = 0;
  uint32_t texture = kNone;
};

// ---- materials ------------------------------------------------------------------------------------------------------

enum class Distribution { ggx, beckmann };

struct Diffuse {
  TexturedRgb reflectance{{0.5, 0.5, 0.5}};
};
struct Conductor {  // alpha == 0: smooth
  Rgb eta{0, 0, 0}, k{1, 1, 1};
  bool perfectMirror = false;  // material "none": Fresnel factor 1
  TexturedRgb specularReflectance{{1, 1, 1}};
  TexturedFloat alpha{0};
  Distribution distribution = Distribution::ggx;
};
struct Dielectric {  // alpha == 0: smooth
  double intIor = 1.5046, extIor = 1.000277;
  TexturedRgb specularReflectance{{1, 1, 1}}, specularTransmittance{{1, 1, 1}};
  TexturedFloat alpha{0};
  bool thin = false;
  Distribution distribution = Distribution::ggx;
};
struct Plastic {  // alpha == 0: smooth
  double intIor = 1.49, extIor = 1.000277;
  TexturedRgb diffuseReflectance{{0.5, 0.5, 0.5}}, specularReflectance{{1, 1, 1}};
  TexturedFloat alpha{0};
  bool nonlinear = false;
  Distribution distribution = Distribution::ggx;
};
struct Phong {  // Mitsuba 0.6 `phong`
  TexturedRgb diffuseReflectance{{0.5, 0.5, 0.5}}, specularReflectance{{0.2, 0.2, 0.2}};
  double exponent = 30;
};

// How a bump or normal map is applied (Mitsuba 3's parameters).
struct NormalMapping {
  bool flipInvalidNormals = true;  // mirror a normal that faces away from the eye where the surface does not
  bool shadowing = true;           // soften the terminator
  bool aroundTwoSided = false;     // the map is around `twosided`, not within it
};

struct Material {
  std::string id;
  std::variant<Diffuse, Conductor, Dielectric, Plastic, Phong> kind;
  bool twoSided = false;
  std::optional<TexturedFloat> opacity;  // `mask`
  uint32_t bumpTexture = kNone;          // `bumpmap`
  double bumpScale = 1;
  uint32_t normalTexture = kNone;  // `normalmap`
  NormalMapping normalMapping;     // of either
  SourceLocation source;
};

// ---- shapes ---------------------------------------------------------------------------------------------------------

// Triangles in world space. Winding is counter-clockwise seen from the side the geometric normal points to, with
// flip_normals and mirrored transforms already applied.
struct Mesh {
  std::vector<Float3> positions;
  std::vector<Float3> normals;  // per vertex, unit; empty: the mesh is faceted
  std::vector<Float2> uvs;      // per vertex; empty: Mitsuba's barycentric default
  std::vector<std::array<uint32_t, 3>> triangles;
};
struct Rectangle {  // corner + u * edgeU + v * edgeV, (u, v) in [0,1]^2; normal along edgeU x edgeV
  Double3 corner{}, edgeU{}, edgeV{};
  bool mirrored = false;  // texture coordinates are (1 - u, v): flip_normals, or a transform that mirrors
};
struct Disk {  // centre, two perpendicular radius vectors, normal along axisU x axisV; (u, v) = (r, phi / 2 pi)
  Double3 center{}, axisU{}, axisV{};
  bool mirrored = false;  // texture coordinates are (u, 1 - v)
};
struct Sphere {
  Double3 center{};
  double radius = 1;
  bool flipNormals = false;
  Matrix4 toWorld{};  // rotation part orients (u, v) = (phi / 2 pi, theta / pi) about the local z axis
};
struct Cylinder {  // side wall only, from p0 to p1; (u, v) = (phi / 2 pi, share of the way from p0 to p1)
  Double3 p0{}, p1{};
  double radius = 1;
  bool flipNormals = false;
  Double3 phi0{1, 0, 0}, phi90{0, 1, 0};  // unit directions from the axis where phi is 0 and pi / 2
};

struct Shape {
  std::string id;
  std::variant<Mesh, Rectangle, Disk, Sphere, Cylinder> kind;
  uint32_t material = kNone;  // index into scene.materials
  uint32_t emitter = kNone;   // index into scene.emitters, an AreaEmitter
  SourceLocation source;
};

// ---- emitters -------------------------------------------------------------------------------------------------------

struct AreaEmitter {
  TexturedRgb radiance;  // W / (m^2 sr), on the side of the geometric normal
  uint32_t shape = kNone;
};
struct PointEmitter {
  Double3 position{};
  Rgb intensity{};  // W / sr
};
struct SpotEmitter {
  Double3 position{}, direction{};  // unit direction of travel along the axis
  Rgb intensity{};
  double cutoffAngle = 20, beamWidth = 15;  // degrees, half angles
  uint32_t texture = kNone;
  Matrix4 toWorld{};
};
struct DirectionalEmitter {
  Double3 direction{};  // unit direction of travel
  Rgb irradiance{};     // perpendicular to the direction
};
struct ConstantEmitter {
  Rgb radiance{};
};
struct EnvmapEmitter {
  std::shared_ptr<const Bitmap> bitmap;  // latitude-longitude
  double scale = 1;
  Matrix4 toWorld{};
};

struct Emitter {
  std::variant<AreaEmitter, PointEmitter, SpotEmitter, DirectionalEmitter, ConstantEmitter, EnvmapEmitter> kind;
  SourceLocation source;
};

// ---- camera and film ------------------------------------------------------------------------------------------------

struct Sensor {
  enum class Kind { perspective, thinlens, orthographic };
  static constexpr std::array<std::string_view, 3> kKindNames{"perspective", "thinlens", "orthographic"};  // plugins
  Kind kind = Kind::perspective;
  Matrix4 toWorld{};      // camera looks along +z, +x to the left of the image, +y up, as in Mitsuba
  double fovX = 39.3077;  // horizontal, degrees, already derived from fov_axis and the film's aspect
  // Planes between which the camera sees, along its axis. The loader has Mitsuba's defaults, 0.01 and 10,000.
  double nearClip = 0, farClip = std::numeric_limits<double>::infinity();
  double apertureRadius = 0, focusDistance = 0;  // thinlens
  std::array<double, 2> principalPointOffset{0, 0};
};

enum class ReconstructionFilter { box, tent, gaussian };
constexpr std::array<std::string_view, 3> kFilterNames{"box", "tent", "gaussian"};  // plugins

struct FilmSettings {
  uint32_t width = 768, height = 576;
  uint32_t cropX = 0, cropY = 0, cropWidth = 0, cropHeight = 0;  // crop 0 x 0: the whole film
  ReconstructionFilter filter = ReconstructionFilter::box;
  double filterRadius = 0.5, gaussianStddev = 0.5;  // raster units
};

// What the scene file asks of its <integrator> and <sampler>; the command line overrides each.
struct RenderDefaults {
  int maxDepth = -1, rrDepth = 5;
  uint32_t sampleCount = 16;
};

// Something in a scene file that is approximated or left out, without which the picture is about the same.
struct Note {
  SourceLocation source;  // the first place that says so
  std::string what;       // what the file says
  std::string effect;     // what wavecrest does
  uint32_t count = 1;     // how many places say the same
};

struct Scene {
  std::string name;
  std::vector<Texture> textures;
  std::vector<Material> materials;
  std::vector<Shape> shapes;
  std::vector<Emitter> emitters;
  Sensor sensor;
  FilmSettings film;
  RenderDefaults defaults;
  uint64_t droppedTriangles = 0;      // without area, left out of the meshes
  uint64_t hash = 0;                  // of all data above that can change an image; stable across runs and machines
  std::vector<Note> notes;            // what was approximated or left out
  std::vector<std::string> files;     // that it was read from
  std::vector<std::string> warnings;  // what --lenient skipped
};

}  // namespace wavecrest
