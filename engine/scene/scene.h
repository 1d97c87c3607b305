// The scene as plain data: what the loader produces and what the engine compiles for its kernels.
//
// Everything but shapes of groups is already in world space, and all is in linear Rec.709 RGB; lengths are in scene
// units, angles in degrees where a name says so, IORs are absolute. Indices replace pointers, so a Scene can be copied,
// hashed and compared. The meaning of each field follows Mitsuba 3's plugin of the same name.
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
  // The baked attribute of the one mesh that has it (engine/load/mesh_attributes.h), of which the bitmap is made, and
  // the factor of its values; null: of no mesh.
  std::shared_ptr<const Bitmap> attribute{};
  double attributeScale = 1;
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
  std::optional<TexturedFloat> alphaV{};  // `alpha_v` where it differs from alpha, which is then `alpha_u`
};
struct Dielectric {  // alpha == 0: smooth
  double intIor = 1.5046, extIor = 1.000277;
  TexturedRgb specularReflectance{{1, 1, 1}}, specularTransmittance{{1, 1, 1}};
  TexturedFloat alpha{0};
  bool thin = false;
  Distribution distribution = Distribution::ggx;
  std::optional<TexturedFloat> alphaV{};  // as in Conductor
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

struct Principled {  // `principled`, or `principledthin`
  bool thin = false;
  TexturedRgb baseColor{{0.5, 0.5, 0.5}};
  double eta = 1.5;  // of `principled` also from `specular`
  TexturedFloat roughness{0.5}, anisotropic{0}, specTrans{0}, specTint{0}, sheen{0}, sheenTint{0}, flatness{0};
  TexturedFloat metallic{0}, clearcoat{0}, clearcoatGloss{0};  // not where it is thin
  TexturedFloat diffTrans{0};                                  // only there
};
// `blendbsdf`, or `mixturebsdf` of Mitsuba 0.6: the sum of other materials, which have no bump or normal maps and are
// no blends themselves, times their weights. With a texture t there are two, with weights 1 - t and t.
struct Blend {
  std::vector<uint32_t> materials{};  // indices into scene.materials, below the blend's own
  std::vector<double> weights{};      // empty with a texture; at most 1 together
  uint32_t weightTexture = kNone;
};

// How a bump or normal map is applied (Mitsuba 3's parameters).
struct NormalMapping {
  bool flipInvalidNormals = true;  // mirror a normal that faces away from the eye where the surface does not
  bool shadowing = true;           // soften the terminator
  bool aroundTwoSided = false;     // the map is around `twosided`, not within it
};

struct Material {
  std::string id;
  std::variant<Diffuse, Conductor, Dielectric, Plastic, Phong, Principled, Blend> kind;
  bool twoSided = false;
  std::optional<TexturedFloat> opacity;  // `mask`
  uint32_t bumpTexture = kNone;          // `bumpmap`
  double bumpScale = 1;
  uint32_t normalTexture = kNone;  // `normalmap`
  NormalMapping normalMapping;     // of either
  SourceLocation source;

  bool hasMap() const { return bumpTexture != kNone || normalTexture != kNone; }
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
  uint32_t emitter = kNone;   // index into scene.emitters, an AreaEmitter; shapes of groups have none
  uint32_t group = kNone;     // index into scene.groups, whose space it is in: seen as often as that has instances
  SourceLocation source;
};

struct ShapeGroup {
  std::string id;
  SourceLocation source;
};
struct Instance {
  std::string id;
  uint32_t group = kNone;  // index into scene.groups
  Matrix4 toWorld{};       // affine, with an inverse
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
  uint32_t texture = kNone;                 // factor of the intensity, over the square around the circle of the cutoff
  Matrix4 toWorld{};
};
struct ProjectorEmitter {
  TexturedRgb irradiance;  // the picture
  double scale = 1;        // pi times both is the irradiance at distance 1 on the axis
  double fovX = 39.3077;   // horizontal, degrees
  double aspect = 1;       // width over height of the picture
  Matrix4 toWorld{};       // as that of a camera
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
// The clear sky of Hosek and Wilkie with the sun's disc (Mitsuba 3's sunsky); z of toWorld leads to the zenith.
struct SunskyEmitter {
  double turbidity = 3;
  Rgb albedo{0.3, 0.3, 0.3};  // of the ground
  Double3 sunDirection{};     // unit, towards the sun, in the world
  double sunScale = 1, skyScale = 1;
  double sunAperture = 0.5358;  // degrees from rim to rim
  Matrix4 toWorld{};
};

struct Emitter {
  std::variant<AreaEmitter, PointEmitter, SpotEmitter, DirectionalEmitter, ConstantEmitter, EnvmapEmitter,
               ProjectorEmitter, SunskyEmitter>
      kind;
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

  // Of the image: the crop window's sides, or the film's.
  bool isCropped() const { return cropWidth != 0 && cropHeight != 0; }
  uint32_t imageWidth() const { return isCropped() ? cropWidth : width; }
  uint32_t imageHeight() const { return isCropped() ? cropHeight : height; }
};

// What the scene file asks of its <integrator> and <sampler>; the command line overrides each.
struct RenderDefaults {
  int maxDepth = -1, rrDepth = 5;
  uint32_t sampleCount = 16;
  bool hideEmitters = false;  // rays from the camera do not see the sky
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
  std::vector<ShapeGroup> groups;  // each with an instance
  std::vector<Instance> instances;
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
