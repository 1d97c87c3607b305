// merge against all pairs of vertices and photons, from radii as large as the scene down to those that float can hardly
// tell from nothing; and the grid that photons are found by.
//
// Every photon of a vertex counts 1, so that radiance is a number of photons.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <type_traits>

#include "kernels/columns/light_vertices.h"
#include "kernels/merge/photon_map.h"
#include "tests/kernels/stage_scene.h"

namespace wavecrest {
namespace {

constexpr double kSceneRadius = 2;
constexpr double kCenter[3] = {0.5, -1, 3};

template <class S>
struct Point3 {
  S x[3];
};
template <class S>
Point3<S> pointAt(const double (&p)[3]) {
  return {{static_cast<S>(p[0]), static_cast<S>(p[1]), static_cast<S>(p[2])}};
}

// What merge asks of two points: 1, 0, or -1 where rounding may decide either way.
template <class S>
int merges(const Point3<S>& vertex, const Point3<S>& photon, double radius) {
  double d[3], distance2 = 0;
  for (size_t i = 0; i < 3; ++i) {
    d[i] = static_cast<double>(photon.x[i]) - static_cast<double>(vertex.x[i]);
    distance2 += d[i] * d[i];
  }
  const double within = std::sqrt(distance2) / radius, above = std::abs(d[2]) / (0.5 * radius);  // normals are z
  if (std::abs(within - 1) < 1e-6 || std::abs(above - 1) < 1e-6) return -1;
  return within < 1 && above < 1 ? 1 : 0;
}

// Vertices, and around each some photons: within the radius, just within it, just beyond, in the next cells and farther
// off. What rounding may decide is left out.
template <class S>
struct Cloud {
  std::vector<Point3<S>> vertices, photons;

  // Anywhere in the scene.
  Cloud(size_t count, double radius) : Cloud(scattered(count), radius) {}

  Cloud(std::vector<Point3<S>> around, double radius) : vertices(std::move(around)) {
    std::uniform_real_distribution<double> uniform;
    for (const Point3<S>& z : vertices) {
      for (const double far : {0.0, 0.3, 0.3, 0.999, 0.99999, 1.00001, 1.01, 2.0, 4.0, 9.0, 1000.0}) {
        const double angle = 2 * std::numbers::pi * uniform(random_),
                     up = std::min((uniform(random_) - 0.5) * 0.9, far);
        const double flat = std::sqrt(std::max(far * far - up * up, 0.0));
        const double offset[3] = {flat * std::cos(angle), flat * std::sin(angle), up};
        double p[3], fromCenter2 = 0;
        for (size_t k = 0; k < 3; ++k) {
          p[k] = static_cast<double>(z.x[k]) + radius * offset[k];
          fromCenter2 += (p[k] - kCenter[k]) * (p[k] - kCenter[k]);
        }
        if (fromCenter2 < kSceneRadius * kSceneRadius) photons.push_back(pointAt<S>(p));
      }
    }
    std::erase_if(photons, [&](const Point3<S>& p) {
      return std::any_of(vertices.begin(), vertices.end(),
                         [&](const Point3<S>& z) { return merges(z, p, radius) < 0; });
    });
    std::shuffle(photons.begin(), photons.end(), random_);
  }

 private:
  static std::vector<Point3<S>> scattered(size_t count) {
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    std::vector<Point3<S>> points;
    while (points.size() < count) {
      const D3 direction{normal(random), normal(random), normal(random)};
      const D3 p = direction * (kSceneRadius * std::cbrt(uniform(random)) / length(direction));
      points.push_back(pointAt<S>({kCenter[0] + p[0], kCenter[1] + p[1], kCenter[2] + p[2]}));
    }
    return points;
  }

  std::mt19937_64 random_{7};
};

const auto kOneByOne = [](size_t count, const std::function<void(size_t)>& body) {
  for (size_t i = 0; i < count; ++i) body(i);
};

// The photons in some stores, and the map over them.
template <class S>
struct Photons {
  std::vector<std::unique_ptr<LightStore<S>>> stores;
  PhotonMap<S> map;

  Photons(const std::vector<Point3<S>>& points, const PhotonGrid<S>& grid) {
    constexpr size_t kOfStore = 100;
    std::vector<LightStore<S>*> pointers;
    for (size_t first = 0; first < points.size(); first += kOfStore) {
      const size_t count = std::min(kOfStore, points.size() - first);
      stores.push_back(std::make_unique<LightStore<S>>(kOfStore, ColumnNeeds{}));
      pointers.push_back(stores.back().get());
      stores.back()->beginDepth(count);
      LightVertices<S>& v = stores.back()->vertices;
      v.claim(count);
      for (size_t i = 0; i < count; ++i) {
        const S(&p)[3] = points[first + i].x;
        v.row[i] = {.position = {p[0], p[1], p[2]},
                    .offset = 0,
                    .wi = {0, 0, 1},
                    .tag = oneEdge(),
                    .normal = {0, 0, 1},
                    .dVCM = 0,
                    .throughput = {1, 1, 1},
                    .dVC = 0};
        const auto at = grid.at(p);
        v.cell[i] = at.cell;
        v.place[i] = at.place;
      }
    }
    map.build(pointers, grid, kOneByOne);
  }

  // Turns the surfaces that all photons lie on away from the axis, to this cosine.
  void turn(double cosine) {
    for (const auto& store : stores) {
      for (size_t i = 0; i < store->vertices.size; ++i) {
        S(&normal)[3] = store->vertices.row[i].normal;
        normal[0] = static_cast<S>(std::sqrt(1 - cosine * cosine));
        normal[2] = static_cast<S>(cosine);
      }
    }
  }

  // Lets all photons come from behind their surfaces, by paths that infinitely many others compete with.
  void comeFromBehind() {
    for (const auto& store : stores) {
      for (size_t i = 0; i < store->vertices.size; ++i) {
        store->vertices.row[i].wi[2] = -1;
        store->vertices.row[i].dVC = std::numeric_limits<S>::infinity();
      }
    }
  }

  // Material 0, one edge from the light.
  static S oneEdge() {
    if constexpr (std::is_same_v<S, float>) return std::bit_cast<float>(1u << kMaterialBits);
    return kMaxMaterials;
  }
};

template <class S>
void fillWave(Wave<S>& wave, const std::vector<Point3<S>>& vertices) {
  const size_t count = vertices.size();
  wave.setVertices(count, count);
  wave.radiance.claim(count);
  wave.pathCount = count;
  auto& surfaces = wave.surfaces;
  auto& paths = wave.paths;
  for (uint32_t i = 0; i < count; ++i) {
    wave.rays.originX[i] = vertices[i].x[0];
    wave.rays.originY[i] = vertices[i].x[1];
    wave.rays.originZ[i] = vertices[i].x[2];
    wave.rays.directionX[i] = wave.rays.directionY[i] = 0;
    wave.rays.directionZ[i] = -1;
    wave.hits.primitive[i] = 0;
    surfaces.normalX[i] = surfaces.normalY[i] = 0;
    surfaces.shadingX[i] = surfaces.shadingY[i] = surfaces.baseX[i] = surfaces.baseY[i] = 0;
    surfaces.normalZ[i] = surfaces.shadingZ[i] = surfaces.baseZ[i] = 1;
    surfaces.offset[i] = 0;
    surfaces.uvU[i] = surfaces.uvV[i] = 0;
    paths.throughputR[i] = paths.throughputG[i] = paths.throughputB[i] = 1;
    paths.dVCM[i] = paths.dVC[i] = 0;
    paths.lane[i] = i;
    wave.radiance.red[i] = wave.radiance.green[i] = wave.radiance.blue[i] = 0;
  }
}

struct MergeCase {
  Isa isa;
  Precision precision;
};
std::vector<MergeCase> cases() {
  std::vector<MergeCase> all;
  for (const Isa isa : availableIsas()) {
    for (const Precision precision : {Precision::floating, Precision::doubled}) all.push_back({isa, precision});
  }
  return all;
}
std::string nameOfMerge(const testing::TestParamInfo<MergeCase>& test) {
  return std::string(toString(test.param.isa)) + "_" +
         std::string(kPrecisionNames[static_cast<size_t>(test.param.precision)]);
}
class MergeTest : public testing::TestWithParam<MergeCase> {};
INSTANTIATE_TEST_SUITE_P(Kernels, MergeTest, testing::ValuesIn(cases()), nameOfMerge);

// Merges the photons at the cloud's vertices, into the wave's radiance; how many of them. weights: against other
// strategies.
template <class S>
uint64_t runMerge(const MergeCase& param, const Cloud<S>& cloud, const Photons<S>& found, double radius, Wave<S>& wave,
                  bool weights = false) {
  StageScene<S> scene({quadPrimitive({0, 0, 0}, {1, 0, 0}, {0, 1, 0})});
  MaterialRecord& material = scene.materials[0];
  std::fill_n(material.reflectance, 3, static_cast<float>(std::numbers::pi));  // f = 1
  material.opacity = 1;
  material.reflectanceTexture = material.specularTexture = material.transmittanceTexture = material.alphaTexture =
      material.opacityTexture = material.normalTexture = material.bumpTexture = kNoIndex;
  fillWave(wave, cloud.vertices);
  StageCounters counters;
  StageContext<S> context;
  context.scene = &scene.view;
  context.mis = {.merge = true, .mergeWeights = weights, .mergeNorm = 1, .radius = radius};
  context.depth = 1;
  context.light.photons = &found.map;
  context.counters = &counters;
  findStages<S>(param.isa, param.precision,
                chooseSpecialization(featuresOf(Specialization::diffuseBidirectional), param.precision))
      .merge(context, wave);
  return counters.merges;
}

template <class S>
void expectAllPairs(const MergeCase& param, const Cloud<S>& cloud, const PhotonGrid<S>& grid, double radius) {
  const Photons<S> found(cloud.photons, grid);
  Wave<S> wave(cloud.vertices.size(), ColumnNeeds{});
  const uint64_t merged = runMerge(param, cloud, found, radius, wave);
  size_t sum = 0;
  for (size_t i = 0; i < cloud.vertices.size(); ++i) {
    size_t expected = 0;
    for (const Point3<S>& photon : cloud.photons) expected += merges(cloud.vertices[i], photon, radius) == 1;
    EXPECT_NEAR(static_cast<double>(wave.radiance.red[i]), static_cast<double>(expected), 1e-3) << "vertex " << i;
    sum += expected;
  }
  EXPECT_EQ(merged, sum);
  EXPECT_GT(sum, cloud.vertices.size()) << "photons at all";
}

template <class S>
void expectAllPairsOfEveryRadius(const MergeCase& param, const std::vector<double>& radii) {
  for (const double radius : radii) {
    const Cloud<S> cloud(150, radius);
    for (const double photons : {1.0, 1e3, 1e12}) {  // the fewer, the wider the cells
      SCOPED_TRACE("radius " + std::to_string(radius) + ", grid for " + std::to_string(photons));
      expectAllPairs(param, cloud, PhotonGrid<S>::over(kCenter, kSceneRadius, radius, photons), radius);
    }
  }
}
TEST_P(MergeTest, findsThePhotonsOfEveryPairWithinTheRadius) {
  if (GetParam().precision == Precision::doubled) {
    expectAllPairsOfEveryRadius<double>(GetParam(), {1.5, 1e-2, 1e-4, 1e-6, 1e-9, 1e-12});
  } else {
    // The last are less than the smallest cells there may be, and 8 and 4 ulps of the scene's coordinates.
    expectAllPairsOfEveryRadius<float>(GetParam(), {1.5, 0.2, 1e-2, 1e-3, 1e-4, 2e-6, 1e-6});
  }
}

// Vertices on the edges between four strips of cells, of which some two are alike to the map: same buckets, and in
// places the same bits. A photon counts once all the same.
template <class S>
void expectAllPairsWhereStripsMeet(const MergeCase& param) {
  constexpr double kRadius = 1e-3;
  constexpr uint32_t kBuckets = 4096;  // as few as there are
  const auto grid = PhotonGrid<S>::over(kCenter, kSceneRadius, kRadius, 1e12);
  const double cell = 1 / static_cast<double>(grid.inverseCell);
  const auto edge = [&](uint32_t x, uint32_t y, uint32_t z) {
    return pointAt<S>({static_cast<double>(grid.origin[0]) + x * cell, static_cast<double>(grid.origin[1]) + y * cell,
                       static_cast<double>(grid.origin[2]) + z * cell});
  };
  std::vector<Point3<S>> vertices;
  const uint32_t middle = static_cast<uint32_t>(kSceneRadius / cell), some = middle / 2;
  for (uint32_t y = middle - some; y < middle + some; ++y) {
    for (uint32_t z = middle - some; z < middle + some; ++z) {
      const uint32_t strip = PhotonGrid<S>::strip(y - 1, z - 1);
      for (const uint32_t other :
           {PhotonGrid<S>::strip(y, z - 1), PhotonGrid<S>::strip(y - 1, z), PhotonGrid<S>::strip(y, z)}) {
        const bool alike = (strip + 1 - other) % kBuckets <= 2 && (strip ^ other) >> kPlaceStripShift == 0;
        if (alike) vertices.push_back(edge(middle, y, z));
      }
    }
  }
  ASSERT_GT(vertices.size(), 20u);
  expectAllPairs(param, Cloud<S>(vertices, kRadius), grid, kRadius);
}
TEST_P(MergeTest, findsAPhotonOnceWhereStripsShareBuckets) {
  if (GetParam().precision == Precision::doubled) {
    expectAllPairsWhereStripsMeet<double>(GetParam());
  } else {
    expectAllPairsWhereStripsMeet<float>(GetParam());
  }
}

// Vertices between two cells along x, of which the first has the last bucket and the second the first.
template <class S>
void expectAllPairsBeyondTheLastBucket(const MergeCase& param) {
  constexpr double kRadius = 1e-3;
  const auto grid = PhotonGrid<S>::over(kCenter, kSceneRadius, kRadius, 1e12);
  const double cell = 1 / static_cast<double>(grid.inverseCell);
  const uint32_t middle = static_cast<uint32_t>(kSceneRadius / cell);
  std::vector<Point3<S>> vertices;
  for (uint32_t y = middle; y < middle + 400; y += 10) {
    const uint32_t strip = PhotonGrid<S>::strip(y, middle);
    for (uint32_t x = middle - 400; x < middle + 400; ++x) {
      if ((strip + x) % 4096 != 4095) continue;
      double p[3];
      const double inCells[3] = {x + 1.0, y + 0.5, middle + 0.5};
      for (size_t k = 0; k < 3; ++k) p[k] = static_cast<double>(grid.origin[k]) + inCells[k] * cell;
      vertices.push_back(pointAt<S>(p));
    }
  }
  ASSERT_GT(vertices.size(), 4u);
  expectAllPairs(param, Cloud<S>(vertices, kRadius), grid, kRadius);
}
TEST_P(MergeTest, findsPhotonsBeyondTheLastBucket) {
  if (GetParam().precision == Precision::doubled) {
    expectAllPairsBeyondTheLastBucket<double>(GetParam());
  } else {
    expectAllPairsBeyondTheLastBucket<float>(GetParam());
  }
}

// Neighbours on a surface that turns by more than METHODS 6.2 allows do not merge; those that turn by less do.
template <class S>
void expectNormalThreshold(const MergeCase& param) {
  for (const double cosine : {0.2, 0.11, 0.09, 0.0, -0.5}) {
    const Cloud<S> cloud(8, 1e-2);
    const auto grid = PhotonGrid<S>::over(kCenter, kSceneRadius, 1e-2, 1e3);
    Photons<S> found(cloud.photons, grid);
    found.turn(cosine);
    Wave<S> wave(cloud.vertices.size(), ColumnNeeds{});
    EXPECT_EQ(runMerge(param, cloud, found, 1e-2, wave) > 0, cosine > 0.1) << cosine;
  }
}
TEST_P(MergeTest, leavesOutPhotonsThatFaceElsewhere) {
  if (GetParam().precision == Precision::doubled) {
    expectNormalThreshold<double>(GetParam());
  } else {
    expectNormalThreshold<float>(GetParam());
  }
}

// There f and its density are 0. With the photon's infinite sum the weight is no number.
template <class S>
void expectNothingFromBehind(const MergeCase& param) {
  const Cloud<S> cloud(8, 1e-2);
  Photons<S> found(cloud.photons, PhotonGrid<S>::over(kCenter, kSceneRadius, 1e-2, 1e3));
  found.comeFromBehind();
  Wave<S> wave(cloud.vertices.size(), ColumnNeeds{});
  EXPECT_GT(runMerge(param, cloud, found, 1e-2, wave, true), 0u);
  for (size_t i = 0; i < cloud.vertices.size(); ++i) EXPECT_EQ(wave.radiance.red[i], S(0)) << "vertex " << i;
}
TEST_P(MergeTest, addsNothingOfPhotonsFromBehindWhateverTheirSums) {
  if (GetParam().precision == Precision::doubled) {
    expectNothingFromBehind<double>(GetParam());
  } else {
    expectNothingFromBehind<float>(GetParam());
  }
}

// ---- the grid -------------------------------------------------------------------------------------------------------

// Cells and places counted in double by their definition: exact where S is float.
TEST(PhotonGrid, placesAreWhatTheyAreDefinedAs) {
  const auto grid = PhotonGrid<float>::over(kCenter, kSceneRadius, 1e-3, 1e5);
  const Cloud<float> cloud(300, 1e-3);
  for (const Point3<float>& p : cloud.photons) {
    uint32_t cell[3], quanta[3];
    for (size_t i = 0; i < 3; ++i) {
      const auto inCells = static_cast<double>((p.x[i] - grid.origin[i]) * grid.inverseCell);
      cell[i] = static_cast<uint32_t>(inCells);
      quanta[i] = static_cast<uint32_t>(inCells * 256) % 512;
    }
    const uint32_t strip = PhotonGrid<float>::strip(cell[1], cell[2]);
    const auto at = grid.at(p.x);
    EXPECT_EQ(at.cell, strip + cell[0]);
    EXPECT_EQ(at.place % (1u << 27), quanta[0] + 512 * quanta[1] + 512 * 512 * quanta[2]);
    EXPECT_EQ(at.place >> 27, strip >> 27);
  }
}

TEST(PhotonGrid, cellsAreAsWideAsASearchAndWiderWherePhotonsAreFew) {
  const double radius = 1e-3;
  const auto many = PhotonGrid<double>::over(kCenter, kSceneRadius, radius, 1e12);
  EXPECT_GT(1 / many.inverseCell, 2 * radius);
  EXPECT_LT(1 / many.inverseCell, 2.001 * radius);
  double last = 1 / many.inverseCell;
  for (const double photons : {1e5, 1e4, 1e3}) {
    const double cell = 1 / PhotonGrid<double>::over(kCenter, kSceneRadius, radius, photons).inverseCell;
    EXPECT_GT(cell, last);
    last = cell;
  }
  // Not so narrow that float could not count them.
  const auto narrow = PhotonGrid<float>::over(kCenter, kSceneRadius, 1e-9, 1e12);
  EXPECT_LT(2 * kSceneRadius * static_cast<double>(narrow.inverseCell), 1 << 21);
}

}  // namespace
}  // namespace wavecrest
