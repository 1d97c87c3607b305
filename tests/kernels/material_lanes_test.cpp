// Every field of every lane's material and primitive, whether they are gathered or looked up in a table; and materials
// in the tags of vertices.
#include <bit>
#include <cstring>
#include <span>
#include <vector>

#include "engine/compile/tabulate.h"
#include "tests/kernels/bsdf_entries.h"
#include "tests/kernels/isa_test.h"

namespace wavecrest {
namespace {

constexpr uint32_t kElement = 37;  // of roughTransmittance

// Word w of material m; as a float, a number like any other.
uint32_t wordOf(size_t material, size_t w) { return static_cast<uint32_t>(0x3f800000 + 1000 * w + material); }

template <class Record>
std::vector<Record> distinctRecords(size_t count) {
  std::vector<Record> records(count);
  for (size_t r = 0; r < count; ++r) {
    uint32_t words[sizeof(Record) / sizeof(uint32_t)];
    for (size_t w = 0; w < std::size(words); ++w) words[w] = wordOf(r, w);
    std::memcpy(&records[r], words, sizeof(words));
  }
  return records;
}

class MaterialLanesTest : public IsaTest {};
WAVECREST_TEST_EVERY_ISA(MaterialLanesTest);

TEST_P(MaterialLanesTest, readEveryFieldOfAnyNumberOfMaterials) {
  for (const size_t count : {1u, 2u, 4u, 5u, 8u, 9u, 16u, 17u, 100u}) {
    const std::vector<MaterialRecord> materials = distinctRecords<MaterialRecord>(count);
    const auto table = tabulate<MaterialTable>(std::span<const MaterialRecord>(materials));
    EXPECT_EQ(table != nullptr, count <= MaterialTable::kRecords);
    SceneView<float> scene;
    scene.materials = materials.data();
    scene.materialTable = table.get();
    scene.materialCount = static_cast<uint32_t>(count);
    uint32_t index[MaterialTable::kRecords];
    for (size_t i = 0; i < MaterialTable::kRecords; ++i) index[i] = static_cast<uint32_t>((7 * i + count - 1) % count);
    MaterialWords read;
    entries<BsdfEntries>().readMaterials(scene, index, kElement, &read);
    for (size_t i = 0; i < entries<BsdfEntries>().lanes; ++i) {
      const MaterialRecord& expected = materials[index[i]];
      for (size_t w = 0; w < MaterialTable::kWords; ++w) {
        EXPECT_EQ(read.words[w][i], wordOf(index[i], w)) << count << " materials, word " << w << ", lane " << i;
      }
      EXPECT_EQ(read.transmittance[i], expected.roughTransmittance[kElement]);
      for (size_t c = 0; c < 3; ++c) {
        EXPECT_EQ(read.specular[c][i], expected.specular[c]);
        EXPECT_EQ(read.reflectance[c][i], expected.reflectance[c]);
      }
      EXPECT_EQ(std::bit_cast<uint32_t>(read.reflectance[3][i]), expected.flags);
    }
  }
}

TEST_P(MaterialLanesTest, readEveryFieldOfAnyNumberOfPrimitives) {
  for (const size_t count : {1u, 2u, 3u, 4u, 8u, 9u, 15u, 16u, 17u, 18u, 31u, 32u, 33u, 100u}) {
    const auto primitives = distinctRecords<PrimitiveRecord<float>>(count);
    const auto table = tabulate<PrimitiveTable>(std::span<const PrimitiveRecord<float>>(primitives));
    EXPECT_EQ(table != nullptr, count <= 32);
    SceneView<float> scene;
    scene.primitives = primitives.data();
    scene.primitiveTable = table.get();
    scene.primitiveCount = static_cast<uint32_t>(count);
    for (size_t first = 0; first < count; first += entries<BsdfEntries>().lanes) {
      uint32_t index[kMostLanes];
      for (size_t i = 0; i < kMostLanes; ++i) index[i] = static_cast<uint32_t>((first + 5 * i) % count);
      PrimitiveWords read;
      entries<BsdfEntries>().readPrimitives(scene, index, &read);
      for (size_t i = 0; i < entries<BsdfEntries>().lanes; ++i) {
        for (size_t w = 0; w < PrimitiveTable::kWords; ++w) {
          EXPECT_EQ(read.words[w][i], wordOf(index[i], w)) << count << " primitives, word " << w << ", lane " << i;
        }
        for (size_t c = 0; c < 3; ++c) EXPECT_EQ(read.normal[c][i], primitives[index[i]].normal[c]);
      }
    }
  }
}

TEST_P(MaterialLanesTest, comeThroughATagWithEdges) {
  for (const Precision precision : {Precision::floating, Precision::doubled}) {
    for (const uint32_t material : {0u, 1u, 12345u, kMaxMaterials / 2 + 1, kMaxMaterials - 1}) {
      for (const uint32_t edges : {0u, 1u, 2u, 63u, 64u, 127u, 128u, kMostEdges}) {
        const auto back = entries<BsdfEntries>().throughTag(precision, material, edges);
        EXPECT_EQ(back[0], material) << edges << " edges";
        EXPECT_EQ(back[1], edges) << "material " << material;
      }
    }
  }
}

}  // namespace
}  // namespace wavecrest
