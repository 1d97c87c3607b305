// How often each light is picked: half by the power that it sends onto the scene, half evenly among emitters that
// are not black.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "engine/compile/compiled_scene.h"
#include "engine/compile/lights.h"
#include "engine/compile/pick_table.h"
#include "tests/load/scene_file.h"

namespace wavecrest {
namespace {

// A floor of side 2 h, and emitters.
Scene floorWith(const std::string& emitters, double h = 1) {
  return loadBody("<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"" + std::to_string(h) +
                  "\"/></transform></shape>" + emitters);
}
std::string lamp(double side, double radiance, const std::string& shape = "rectangle") {
  return "<shape type=\"" + shape + "\"><transform name=\"to_world\"><scale value=\"" + std::to_string(side / 2) +
         "\"/></transform><emitter type=\"area\"><rgb name=\"radiance\" value=\"" + std::to_string(radiance) +
         "\"/></emitter></shape>";
}
std::string pointLight(double intensity) {
  return "<emitter type=\"point\"><rgb name=\"intensity\" value=\"" + std::to_string(intensity) + "\"/></emitter>";
}

std::vector<double> picksOf(const Scene& scene) {
  const auto compiled = compileScene<double>(scene, Accel::bvh);
  std::vector<double> picks;
  for (const LightRecord<double>& record : compiled->lights.records) picks.push_back(record.pick);
  return picks;
}

// Drawn by numbers k 2^-24: each share is that of the numbers that lead to it.
TEST(AliasTable, drawsTheSmallestSharesAsOftenAsItSays) {
  const std::vector<double> weights{1, 1e-9, 1e-8, 2, 3e-7, 0, 0.5};
  const std::vector<AliasEntry> table = makeAliasTable(weights);
  const std::vector<double> shares = sharesOf(table, entryShares(table.size()));
  std::vector<double> drawn(weights.size(), 0);
  for (size_t i = 0; i < table.size(); ++i) {
    const double kept = std::ceil(static_cast<double>(table[i].keep) * 0x1p24) * 0x1p-24;
    drawn[i] += kept / static_cast<double>(table.size());
    drawn[table[i].other] += (1 - kept) / static_cast<double>(table.size());
  }
  double sum = 0;
  for (const double weight : weights) sum += weight;
  for (size_t i = 0; i < weights.size(); ++i) {
    EXPECT_NEAR(shares[i], drawn[i], 1e-6 * drawn[i]) << i;
    EXPECT_NEAR(shares[i], weights[i] / sum, 0x1p-23)
        << i << ": each entry is rounded by less than 2^-24, and chosen so";
  }
  EXPECT_EQ(shares[5], 0) << "what has no weight is never drawn";
}

// A million entries have 16 or 17 of the 2^24 numbers each.
TEST(AliasTable, entriesAreChosenByAsManyNumbersAsTheySay) {
  for (const size_t count : {size_t{3}, size_t{1000}, size_t{1'000'000}, size_t{1} << 24}) {
    std::vector<double> chosen(count, 0);
    for (uint32_t i = 0; i < 1u << 24; ++i) {
      const float number = static_cast<float>(i) * 0x1p-24f;
      chosen[std::min(static_cast<size_t>(number * static_cast<float>(count)), count - 1)] += 0x1p-24;
    }
    EXPECT_EQ(entryShares(count), chosen) << count;
  }
}

// Of an environment that is dark but for a sun, each texel is drawn as often as its density says.
TEST(AliasTable, ofAnEnvironmentIsWhatItsDensitySays) {
  auto bitmap = std::make_shared<Bitmap>();
  bitmap->width = 32;
  bitmap->height = 16;
  bitmap->channels = 1;
  bitmap->pixels.assign(size_t{32} * 16, 1e-8f);
  bitmap->pixels[5 * 32 + 7] = 100;
  EnvmapEmitter emitter;
  emitter.bitmap = bitmap;
  const Environment environment = compileEnvironment(emitter);
  std::vector<double> drawn(size_t{32} * 16, 0);
  for (size_t i = 0; i < drawn.size(); ++i) {
    const double kept = std::ceil(static_cast<double>(environment.table[i].keep) * 0x1p24) * 0x1p-24;
    const uint32_t other = environment.table[i].other, mask = (1u << kTexelBits) - 1;
    drawn[i] += kept / 512;
    drawn[(other >> kTexelBits) * 32 + (other & mask)] += (1 - kept) / 512;
  }
  for (size_t i = 0; i < drawn.size(); ++i) {
    EXPECT_NEAR(static_cast<double>(environment.probability[i]), drawn[i], 1e-6 * drawn[i]) << i;
  }
}

TEST(LightPicks, areHalfByPowerAndHalfEven) {
  // pi A L = 4 pi 3 and 4 pi I = 4 pi: three fourths and one fourth of the power.
  const std::vector<double> picks = picksOf(floorWith(lamp(2, 3) + pointLight(1)));
  ASSERT_EQ(picks.size(), 2u);
  EXPECT_NEAR(picks[0], 0.5 * 0.75 + 0.25, 1e-12);
  EXPECT_NEAR(picks[1], 0.5 * 0.25 + 0.25, 1e-12);
}

TEST(LightPicks, ofTheFacesOfOneLampAddUpToThoseOfOneEmitter) {
  const std::vector<double> picks = picksOf(floorWith(lamp(2, 1, "cube") + pointLight(1000)));
  ASSERT_EQ(picks.size(), 7u);
  const double byPower = 24 / (24 + 4000.0);  // over pi
  for (size_t face = 0; face < 6; ++face) EXPECT_NEAR(picks[face], (0.5 * byPower + 0.25) / 6, 0x1p-23) << face;
}

TEST(LightPicks, countWhatLightFromFarAwaySendsOntoTheScenesBox) {
  // A flat box of side 10: pi times a fourth of its surface, 50; a point light of the same flux is picked as often.
  const double flux = std::numbers::pi * 50;
  const std::vector<double> picks =
      picksOf(floorWith("<emitter type=\"constant\"/>" + pointLight(flux / (4 * std::numbers::pi)), 5));
  ASSERT_EQ(picks.size(), 2u);
  EXPECT_NEAR(picks[0], 0.5, 1e-3) << "the box is a little wider than the floor";
  // Along the floor the sun meets only the edge of the box.
  const auto sun = [](const char* direction) {
    return std::string("<emitter type=\"directional\"><vector name=\"direction\" value=\"") + direction +
           "\"/></emitter>";
  };
  EXPECT_NEAR(picksOf(floorWith(sun("1, 0, 0") + pointLight(1), 5))[0], 0.25, 0.01);
  EXPECT_GT(picksOf(floorWith(sun("0, 0, -1") + pointLight(1), 5))[0], 0.25 + 0.5 * 0.85);
}

TEST(LightPicks, leaveOutBlackEmitters) {
  EXPECT_EQ(picksOf(floorWith(lamp(2, 0) + pointLight(1))), (std::vector<double>{0, 1}));
  const std::vector<double> picks = picksOf(floorWith(pointLight(3) + pointLight(0) + pointLight(1)));
  ASSERT_EQ(picks.size(), 3u);
  EXPECT_NEAR(picks[0], 0.5 * 0.75 + 0.25, 0x1p-23);
  EXPECT_EQ(picks[1], 0);
  EXPECT_NEAR(picks[2], 0.5 * 0.25 + 0.25, 0x1p-23);
}

TEST(LightPicks, addUpToOneWhereNothingShines) {
  const std::vector<double> picks = picksOf(floorWith(lamp(2, 0) + pointLight(0)));
  ASSERT_EQ(picks.size(), 2u);
  EXPECT_DOUBLE_EQ(picks[0], 0.5);
  EXPECT_DOUBLE_EQ(picks[1], 0.5);
}

}  // namespace
}  // namespace wavecrest
