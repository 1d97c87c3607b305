// Groups: what goes across their values, against the same in plain code.
#include "tests/kernels/group_entries.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "tests/kernels/isa_test.h"

namespace wavecrest {
namespace {

struct alignas(64) Eight {
  uint32_t present[8], items[8];
  float keys[8];
};

class GroupTest : public IsaTest {
 protected:
  // Every choice of what is present, with keys that are often equal or all but equal.
  template <class Check>
  void forManyGroups(const Check& check) {
    std::mt19937 random(5);
    constexpr float kKeys[] = {0, 1e-30f, 1, 1.0000002f, 2, 3, 1e30f, std::numeric_limits<float>::infinity()};
    for (uint32_t choice = 0; choice < 256; ++choice) {
      for (size_t round = 0; round < 40; ++round) {
        Eight group;
        for (uint32_t i = 0; i < 8; ++i) {
          group.present[i] = choice >> i & 1;
          group.items[i] = 1000 * (choice + 1) + i;
          group.keys[i] = round % 2 == 0 ? kKeys[random() % 8] : static_cast<float>(random()) * 1e-5f;
        }
        check(group);
      }
    }
  }
  static std::vector<uint32_t> placesOf(const Eight& group) {
    std::vector<uint32_t> places;
    for (uint32_t i = 0; i < 8; ++i) {
      if (group.present[i] != 0) places.push_back(i);
    }
    return places;
  }
};
WAVECREST_TEST_EVERY_ISA(GroupTest);

TEST_P(GroupTest, appendsWhatIsPresentInOrder) {
  forManyGroups([&](const Eight& group) {
    uint32_t out[16];
    const auto want = placesOf(group);
    ASSERT_EQ(entries<GroupEntries>().appendWhere(group.present, group.items, out), want.size());
    for (size_t i = 0; i < want.size(); ++i) ASSERT_EQ(out[i], group.items[want[i]]);
  });
}

TEST_P(GroupTest, appendsByFallingKeyThenByPlace) {
  forManyGroups([&](const Eight& group) {
    auto want = placesOf(group);
    const auto key = [&](uint32_t i) {  // without the bits that do not count
      uint32_t bits;
      std::memcpy(&bits, group.keys + i, sizeof(bits));
      return bits & ~7u;
    };
    std::stable_sort(want.begin(), want.end(), [&](uint32_t a, uint32_t b) { return key(a) > key(b); });
    uint32_t out[16];
    ASSERT_EQ(entries<GroupEntries>().appendByFallingKey(group.present, group.keys, group.items, out), want.size());
    for (size_t i = 0; i < want.size(); ++i) ASSERT_EQ(out[i], group.items[want[i]]) << i;
  });
}

TEST_P(GroupTest, leastIsTheFirstOfTheLeast) {
  forManyGroups([&](const Eight& group) {
    float least;
    const size_t index = entries<GroupEntries>().leastOf(group.keys, &least);
    const float* const want = std::min_element(group.keys, group.keys + 4);
    ASSERT_EQ(index, static_cast<size_t>(want - group.keys));
    ASSERT_EQ(least, *want);
  });
}

TEST_P(GroupTest, bytesBecomeNumbers) {
  uint8_t bytes[257];
  for (size_t i = 0; i < 257; ++i) bytes[i] = static_cast<uint8_t>(i);
  for (size_t from = 0; from <= 248; ++from) {
    alignas(64) float out[8];
    entries<GroupEntries>().loadBytes(bytes + from, out);
    for (size_t i = 0; i < 8; ++i) ASSERT_EQ(out[i], static_cast<float>(from + i));
  }
}

}  // namespace
}  // namespace wavecrest
