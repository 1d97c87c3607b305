// Every intersector behind one pair of stages, as tests run them: Embree, and on each instruction set those of small
// and of large scenes; and batches of rays to send through.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/kernels/stage_scene.h"

namespace wavecrest {

struct Intersector {
  std::string name;
  Stage<float> extend, occlude;
  Stage<double> extendPrecise;
  uint32_t depth = 2;  // that stages are told: at 1 the hierarchy takes rays in packets
};

inline std::vector<Intersector> allIntersectors() {
  std::vector<Intersector> list{{"embree", extendEmbree<float>, occludeEmbree<float>, extendEmbree<double>}};
  for (const Isa isa : availableIsas()) {
    const auto& stages = findStages<float>(
        isa, Precision::floating, chooseSpecialization(featuresOf(Specialization::smooth), Precision::floating));
    const auto& precise = findStages<double>(isa, Precision::doubled, chooseSpecialization(0, Precision::doubled));
    const std::string suffix = "_" + std::string(toString(isa));
    list.push_back({"packets" + suffix, stages.extendBvh, stages.occludeBvh, precise.extendBvh, 1});
    list.push_back({"bvh" + suffix, stages.extendBvh, stages.occludeBvh, precise.extendBvh});
    list.push_back({"small" + suffix, stages.extendSmall, stages.occludeSmall, precise.extendSmall});
  }
  return list;
}

// Embree, and the widest of each of the others.
inline std::vector<Intersector> fastestIntersectors() {
  std::vector<Intersector> all = allIntersectors();
  all.erase(all.begin() + 1, all.end() - 3);
  return all;
}

// One ray as the intersectors see it.
struct TestRay {
  Point origin, direction;  // representable in float
};
inline TestRay roundedRay(const Point& origin, const Point& direction) {
  TestRay ray;
  for (size_t i = 0; i < 3; ++i) {
    ray.origin[i] = static_cast<float>(origin[i]);
    ray.direction[i] = static_cast<float>(direction[i]);
  }
  return ray;
}
// Towards a point.
inline TestRay aimedRay(const Point& origin, const Point& target) {
  return roundedRay(origin, normalized(target - origin));
}

// SplitMix64 (Steele, Lea, Flood 2014): cheap enough not to hide the intersectors' time.
class RandomPoints {
 public:
  explicit RandomPoints(uint64_t seed) : state_(seed) {}
  double uniform(double low, double high) { return low + (high - low) * 0x1p-53 * static_cast<double>(bits() >> 11); }
  Point inCube(double half) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }
  // Every direction, those towards a cube's corners somewhat more often.
  Point direction() {
    for (;;) {
      const Point p = inCube(1);
      if (dot(p, p) > 1e-4) return normalized(p);
    }
  }

 private:
  uint64_t bits() {
    uint64_t x = state_ += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
  }

  uint64_t state_;
};

// A wave that carries nothing but rays, and what the intersectors write.
class RayBatch {
 public:
  static constexpr size_t kCapacity = 2048;

  RayBatch()
      : wave(kCapacity, {.shadingNormals = false,
                         .textures = false,
                         .normalMaps = false,
                         .rouletteScale = false,
                         .connections = false}) {}

  bool full() const { return wave.rays.size == kCapacity; }
  void clear() { wave.rays.size = 0; }
  void push(const TestRay& ray) {
    const size_t i = wave.rays.claim(1);
    wave.rays.originX[i] = static_cast<float>(ray.origin[0]);
    wave.rays.originY[i] = static_cast<float>(ray.origin[1]);
    wave.rays.originZ[i] = static_cast<float>(ray.origin[2]);
    wave.rays.directionX[i] = static_cast<float>(ray.direction[0]);
    wave.rays.directionY[i] = static_cast<float>(ray.direction[1]);
    wave.rays.directionZ[i] = static_cast<float>(ray.direction[2]);
  }
  // Closest hits of all rays, in wave.hits. Returns how many there are of kMiss.
  size_t extend(const Intersector& intersector, const SceneView<float>& scene) {
    run(intersector.extend, intersector.depth, scene);
    size_t misses = 0;
    for (size_t i = 0; i < wave.hits.size; ++i) misses += wave.hits.primitive[i] == kMiss ? 1 : 0;
    return misses;
  }
  // Whether anything blocks each ray at t in (0, length).
  std::vector<bool> occluded(const Intersector& intersector, const SceneView<float>& scene, float length) {
    const size_t count = wave.rays.size;
    auto& shadow = wave.shadowRays;
    shadow.size = wave.radiance.size = 0;
    shadow.claim(count);
    wave.radiance.claim(count);
    for (size_t i = 0; i < count; ++i) {
      shadow.originX[i] = wave.rays.originX[i];
      shadow.originY[i] = wave.rays.originY[i];
      shadow.originZ[i] = wave.rays.originZ[i];
      shadow.directionX[i] = wave.rays.directionX[i] * length;
      shadow.directionY[i] = wave.rays.directionY[i] * length;
      shadow.directionZ[i] = wave.rays.directionZ[i] * length;
      shadow.red[i] = shadow.green[i] = shadow.blue[i] = 1;
      shadow.target[i] = static_cast<uint32_t>(i);
      wave.radiance.red[i] = wave.radiance.green[i] = wave.radiance.blue[i] = 0;
    }
    run(intersector.occlude, intersector.depth, scene);
    std::vector<bool> blocked(count);
    for (size_t i = 0; i < count; ++i) blocked[i] = wave.radiance.red[i] == 0.0f;
    return blocked;
  }

  Wave<float> wave;

 private:
  void run(Stage<float> stage, uint32_t depth, const SceneView<float>& scene) {
    StageCounters counters;
    StageContext<float> context;
    context.scene = &scene;
    context.depth = depth;
    context.counters = &counters;
    stage(context, wave);
  }
};

}  // namespace wavecrest
