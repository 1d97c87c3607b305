#include "engine/inspect/scene_links.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "engine/plan/render_plan.h"
#include "engine/tasks/flush_to_zero.h"

namespace wavecrest {
namespace {

constexpr size_t kPaths = 4096;      // from the eye and from the lights, in each of
constexpr uint32_t kIterations = 4;  // these rounds
constexpr uint32_t kDepth = 12;      // edges; links between kinds show up long before

// ---- what kinds of events a surface has -----------------------------------------------------------------------------

enum Events : uint8_t { kDiffuse = 1, kSpecular = 2, kGlossy = 4 };  // glossy surfaces are diffuse, too

// Whether a surface scatters nothing.
bool isBlack(const MaterialRecord& m) {
  return static_cast<BsdfKind>(m.kind) == BsdfKind::diffuse && m.reflectanceTexture == kNoIndex &&
         m.reflectance[0] + m.reflectance[1] + m.reflectance[2] <= 0 && (m.flags & kHasDelta) == 0;
}

// Whether a surface has a narrow microfacet lobe and no wider one.
bool isGlossy(const MaterialRecord& m) {
  if (m.alphaTexture != kNoIndex || m.alpha >= kGlossyAlpha) return false;
  switch (static_cast<BsdfKind>(m.kind)) {
    case BsdfKind::roughConductor:
    case BsdfKind::roughDielectric:
    case BsdfKind::beckmannConductor:
    case BsdfKind::beckmannDielectric:
    case BsdfKind::anisotropicConductor:
    case BsdfKind::anisotropicDielectric:
    case BsdfKind::anisotropicBeckmannConductor:
    case BsdfKind::anisotropicBeckmannDielectric:
      return true;
    default:
      return false;
  }
}

// The events of a surface, as bits of Events; 0 if it is black.
uint8_t eventsOf(const MaterialRecord& material) {
  if (isBlack(material)) return 0;
  uint8_t events = 0;
  if ((material.flags & kHasFinite) != 0) events |= kDiffuse;
  if ((material.flags & kHasDelta) != 0) events |= kSpecular;
  if (isGlossy(material)) events |= kGlossy;
  return events;
}

// Marks the kinds among these events as seen.
void add(SceneLinks::ByEvent& seen, uint8_t events) {
  seen[0] |= (events & kDiffuse) != 0;
  seen[1] |= (events & kSpecular) != 0;
}

// Whether no ray can meet the light.
bool isDelta(LightKind kind) {
  return kind == LightKind::point || kind == LightKind::spot || kind == LightKind::projector ||
         kind == LightKind::directional;
}

// ---- the size of a light --------------------------------------------------------------------------------------------

// Solid angle of an even sky that has the same integrals of L and L^2: (INT L)^2 / INT L^2.
double effectiveSolidAngle(const EnvironmentView& map) {
  double sum = 0, squares = 0;
  for (uint32_t y = 0; y < map.height; ++y) {
    const double weight = std::sin(std::numbers::pi * (y + 0.5) / map.height) * 2 * std::numbers::pi *
                          std::numbers::pi / (double{1} * map.width * map.height);
    for (uint32_t x = 0; x < map.width; ++x) {
      const float* const texel = map.texels + 3 * (size_t{y} * map.width + x);
      const double value = (double{texel[0]} + texel[1] + texel[2]) / 3;
      sum += weight * value;
      squares += weight * value * value;
    }
  }
  // The sun, whose solid angle is pi times the squared chord.
  if (map.sunShare > 0) {
    const double value = (map.sunRadiance[0] + map.sunRadiance[1] + map.sunRadiance[2]) / 3;
    const double weight = std::numbers::pi * map.sunChord2;
    sum += weight * value;
    squares += weight * value * value;
  }
  return squares > 0 ? sum * sum / squares : 0;
}

// Of the smallest extended light, from a distance of the scene's radius, in sr. At most the whole sphere.
double smallestSolidAngle(const Scene& scene, const CompiledScene<float>& compiled) {
  constexpr double kSphere = 4 * std::numbers::pi;
  const SceneView<float>& view = compiled.view;
  double smallest = kSphere;
  // Faces of one emitter count together.
  std::vector<double> areas(scene.emitters.size(), 0);
  const auto& primitives = compiled.primitives;
  for (size_t i = 0; i < primitives.shapeOf.size(); ++i) {
    const uint32_t light = primitives.records[i].light;
    if (light != kNoIndex) areas[scene.shapes[primitives.shapeOf[i]].emitter] += 1 / view.lights[light].inverseArea;
  }
  for (const double area : areas) {
    if (area > 0) smallest = std::min(smallest, area / (view.radius * view.radius));
  }
  if (view.environment.width != 0) smallest = std::min(smallest, effectiveSolidAngle(view.environment));
  return smallest;
}

// ---- walking --------------------------------------------------------------------------------------------------------

// Walks light and camera paths with the stages of the kernels, and looks at their vertices between the stages.
class Walker {
 public:
  explicit Walker(const Scene& scene)
      : plan_(planRender<float>(scene, settings())),
        stages_(findStages<float>(plan_.isa, Precision::floating, plan_.specialization)),
        intersector_(chooseIntersector(stages_, *plan_.scene)),
        area_(filmArea(scene.film)),
        wave_(kPaths, plan_.needs) {
    for (const MaterialRecord& material : plan_.scene->materials) events_.push_back(eventsOf(material));
    // Pixels all over the film, whatever its size.
    pixels_.resize(kPaths * kIterations + kColumnPadding, area_.pixels.front());
    for (size_t i = 0; i < kPaths * kIterations; ++i) {
      pixels_[i] = area_.pixels[i * area_.pixels.size() / (kPaths * kIterations)];
    }
    links_.lightSolidAngle = smallestSolidAngle(scene, *plan_.scene);
  }

  SceneLinks walk() {
    const FlushToZero flushToZero;
    for (uint32_t iteration = 0; iteration < kIterations; ++iteration) {
      if (plan_.view.lightCount != 0) walkFrom(Walk::light, iteration);
      walkFrom(Walk::camera, iteration);
    }
    links_.onlyGlossyPairs = links_.between[0][0] && !roughPairs_;
    links_.cameraCoverage = lightVertices_.share();
    links_.lightCoverage = cameraVertices_.share();
    return links_;
  }

 private:
  static RenderSettings settings() {
    RenderSettings settings;
    settings.method = Method::lt;  // the kernels of both walks
    settings.isa = bestIsa();
    return settings;
  }

  // One round of paths from the lights or from the eye.
  void walkFrom(Walk walk, uint32_t iteration) {
    // The context of the stages. The sampler is seeded with 0, so that every run walks the same paths.
    wave_.firstPath = iteration * kPaths;
    wave_.pathCount = kPaths;
    StageContext<float> context;
    context.scene = &plan_.view;
    context.pixels = pixels_.data();
    context.sampler = {SamplerKind::independent, 0, iteration};
    context.walk = walk;
    context.mis.lightPaths = kPaths;
    context.film = area_.window();
    context.counters = &counters_;
    // Begin the paths, then take them from vertex to vertex.
    previous_.assign(kPaths, 0);
    (walk == Walk::light ? stages_.generateLightPaths : stages_.generateCameraPaths)(context, wave_);
    if (walk == Walk::light) noteLights();
    for (context.depth = 1; context.depth <= kDepth && wave_.rays.size != 0; ++context.depth) {
      intersector_.extend(context, wave_);
      if (walk == Walk::camera && context.depth == 1) noteMisses();
      stages_.arrive(context, wave_);
      noteEvents(walk, context.depth);
      if (walk == Walk::camera) countLit(context);
      if (walk == Walk::light) countSeen(context);
      stages_.scatter(context, wave_);
    }
  }

  // The kind of light on which each light path begins.
  void noteLights() {
    lightOf_.assign(kPaths, LightKindOfPath::extended);
    for (size_t i = 0; i < wave_.rays.size; ++i) {
      const auto kind = static_cast<LightKind>(plan_.view.lights[wave_.paths.light[i]].kind);
      if (isDelta(kind)) lightOf_[wave_.paths.lane[i]] = LightKindOfPath::delta;
    }
  }

  // Camera rays that leave the scene see its infinite light, unless it hides.
  void noteMisses() {
    const SceneView<float>& view = plan_.view;
    if (view.infiniteLight == kNoIndex || view.hidesInfinite) return;
    for (size_t i = 0; i < wave_.rays.size; ++i) links_.eyeMeetsLight |= wave_.hits.primitive[i] == kMiss;
  }

  // Marks the link from each path's vertex before, or from its light or the eye, to the vertex here.
  void noteEvents(Walk walk, uint32_t depth) {
    for (size_t i = 0; i < wave_.rays.size; ++i) {
      const auto& primitive = plan_.view.primitives[wave_.hits.primitive[i]];
      const uint32_t lane = wave_.paths.lane[i];
      const uint8_t here = events_[primitive.material], before = previous_[lane];
      if ((here & kDiffuse) != 0) ++(walk == Walk::light ? lightVertices_ : cameraVertices_).all;
      if (depth > 1) {
        for (size_t a = 0; a < 2; ++a) {
          for (size_t b = 0; b < 2; ++b) {
            if ((before >> a & 1) != 0 && (here >> b & 1) != 0) links_.between[a][b] = links_.between[b][a] = true;
          }
        }
        roughPairs_ |= (before & here & kDiffuse) != 0 && (before & here & kGlossy) == 0;
      } else if (walk == Walk::light) {
        add(links_.fromLight[static_cast<size_t>(lightOf_[lane])], here);
      } else {
        add(links_.fromEye, here);
        links_.eyeSeesGlossy |= (here & kGlossy) != 0;
        // An area light emits on the side of its normal alone.
        const float cosine = -(wave_.rays.directionX[i] * wave_.surfaces.normalX[i] +
                               wave_.rays.directionY[i] * wave_.surfaces.normalY[i] +
                               wave_.rays.directionZ[i] * wave_.surfaces.normalZ[i]);
        links_.eyeMeetsLight |= primitive.light != kNoIndex && cosine > 0;
      }
      previous_[lane] = here;
    }
  }

  // Counts the vertices of camera paths that a shadow ray of next event estimation joins with a light. Every shadow ray
  // is made to carry 1, so the radiance that arrives is the count.
  void countLit(StageContext<float>& context) {
    if (context.scene->lightCount == 0) return;
    stages_.nextEvent(context, wave_);
    carryOne();
    std::fill_n(&wave_.radiance.red[0], kPaths, 0.0f);
    intersector_.occlude(context, wave_);
    for (size_t i = 0; i < kPaths; ++i) cameraVertices_.joined += static_cast<double>(wave_.radiance.red[i]);
  }

  // Makes every shadow ray carry 1, in the red channel.
  void carryOne() {
    auto& rays = wave_.shadowRays;
    for (size_t i = 0; i < rays.size; ++i) {
      rays.red[i] = 1;
      rays.green[i] = rays.blue[i] = 0;
    }
  }

  // The same for the vertices of light paths and the lens, by the splats that arrive.
  void countSeen(StageContext<float>& context) {
    stages_.connectToCamera(context, wave_);
    carryOne();
    intersector_.occlude(context, wave_);
    for (size_t i = 0; i < wave_.splats.size; ++i) lightVertices_.joined += static_cast<double>(wave_.splats.red[i]);
    wave_.splats.size = 0;
  }

  RenderPlan<float> plan_;
  const Stages<float>& stages_;
  Intersector<float> intersector_;
  FilmArea area_;
  Wave<float> wave_;
  std::vector<uint32_t> pixels_;
  std::vector<uint8_t> events_;           // of each material
  std::vector<uint8_t> previous_;         // events at each lane's last vertex
  std::vector<LightKindOfPath> lightOf_;  // where each lane began
  StageCounters counters_;
  SceneLinks links_;
  bool roughPairs_ = false;
  // Numbers of diffuse vertices, and of those that a shadow ray joined with a light or with the lens.
  struct Joined {
    uint64_t all = 0;
    double joined = 0;
    double share() const { return all == 0 ? 0 : joined / static_cast<double>(all); }
  } lightVertices_, cameraVertices_;
};

}  // namespace

SceneLinks findLinks(const Scene& scene) { return Walker(scene).walk(); }

}  // namespace wavecrest
