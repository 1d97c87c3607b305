// Entry points of bsdf_entries.cpp: the BSDFs and Fresnel functions, in float and double.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "kernels/scene_view.h"
#include "kernels/stages.h"

namespace wavecrest {

using Direction = std::array<double, 3>;

// dp/du in the shading frame.
constexpr std::array<double, 2> kTangent{0.8, 0.6};

struct BsdfEvaluation {
  std::array<double, 3> f;
  double pdf, pdfReverse;
};

struct BsdfDraw {
  Direction wo;
  std::array<double, 3> weight;
  double pdf, pdfReverse, etaRatio;
  bool specular;
};

// One material, seen by one walk.
struct BsdfQuery {
  const MaterialRecord* material;
  const CompoundRecord* compounds = nullptr;  // of a compound BSDF, and of its parts, which follow it
  Precision precision = Precision::floating;
  Walk walk = Walk::camera;
  bool specularOnly = false;
};

struct MaterialWords {
  uint32_t words[MaterialTable::kWords][MaterialTable::kRecords];
  float transmittance[MaterialTable::kRecords];
  float specular[3][MaterialTable::kRecords],
      reflectance[4][MaterialTable::kRecords];  // as a vector, and as four numbers
};

constexpr size_t kMostLanes = 16;
struct PrimitiveWords {
  uint32_t words[PrimitiveTable::kWords][kMostLanes];
  float normal[3][kMostLanes];
};

struct BsdfEntries {
  size_t lanes;
  void (*eval)(const BsdfQuery& query, std::span<const Direction> wi, std::span<const Direction> wo,
               BsdfEvaluation* out);
  // u holds the numbers a, b and c of each draw.
  void (*sample)(const BsdfQuery& query, std::span<const Direction> wi, std::span<const std::array<float, 3>> u,
                 BsdfDraw* out);
  // Of the material of each lane: its record's words before the last array, word by word, and what MaterialLanes reads
  // of that array's element.
  void (*readMaterials)(const SceneView<float>& scene, const uint32_t* index, uint32_t element, MaterialWords* out);
  // Of the primitive of each lane: its record word by word, and its normal as a vector.
  void (*readPrimitives)(const SceneView<float>& scene, const uint32_t* index, PrimitiveWords* out);
  // What comes back of a vertex's tag: material and edges.
  std::array<uint32_t, 2> (*throughTag)(Precision precision, uint32_t material, uint32_t edges);
  double (*fresnelDielectric)(Precision precision, double cosine, double eta);
  double (*fresnelConductor)(Precision precision, double cosine, double eta, double k);
};

}  // namespace wavecrest
