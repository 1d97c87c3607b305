// Metropolis light transport in path space: each kind of mutation by itself, and every kind of light.
#include <gtest/gtest.h>

#include "tests/effort.h"
#include "tests/engine/light_scenes.h"
#include "tests/engine/metropolis_settings.h"
#include "tests/engine/test_scenes.h"

namespace wavecrest {
namespace {

// Chains start from the distribution that they are to have, and a mutation that keeps to detailed balance leaves it as
// it is, whether or not it gets everywhere. So each kind of mutation gives the image by itself, with no other beside
// it.
struct MutationCase {
  const char* name;
  uint32_t kinds;
};
class PathMutationTest : public testing::TestWithParam<MutationCase> {
 protected:
  static void expectReference(const Scene& scene, uint64_t mutations) {
    RenderSettings chosen = metropolis(MetropolisVariant::pathspace);
    chosen.metropolis.largeStep = 0;
    chosen.metropolis.directPass = false;
    chosen.metropolis.pathMutations = GetParam().kinds;
    chosen.metropolis.restartSteps = 60;
    RenderSettings other = defaults();
    other.method = Method::bpt;
    const auto session = Session::create(scene, chosen);
    session->renderUntil(2, std::nullopt);
    const ChainStatistics chains = *session->statistics().chains;
    EXPECT_EQ(chains.counters.proposedOf(Mutation::large), 0u);
    uint64_t accepted = 0;
    for (const uint64_t count : chains.counters.accepted) accepted += count;
    EXPECT_GT(accepted, chains.mutations / 50);
    expectSameTruth(renderSeeds(scene, chosen, mutations), renderSeeds(scene, other, samples(192, 48), 2000),
                    scene.name);
  }
};

TEST_P(PathMutationTest, aloneLeavesTheImageAsItIs) {
  expectReference(sceneFile("cornell-diffuse", kWidth, kHeight), samples(128, 80));
}

TEST_P(PathMutationTest, aloneLeavesDeltaLobesAsTheyAre) {
  expectReference(roomScene({.materials = RoomMaterials::mixed, .width = kWidth, .height = kHeight}), samples(128, 80));
}

TEST_P(PathMutationTest, aloneLeavesInfiniteLightsAsTheyAre) {
  expectReference(roomScene({.light = RoomLight::envmap, .width = kWidth, .height = kHeight}), samples(128, 80));
}

INSTANTIATE_TEST_SUITE_P(Engine, PathMutationTest,
                         testing::Values(MutationCase{"from_eye", PathLaw::kFromEye},
                                         MutationCase{"bidirectional", PathLaw::kBidirectional},
                                         MutationCase{"caustic", PathLaw::kCaustic},
                                         MutationCase{"all", PathLaw().kinds}),
                         [](const auto& instance) { return std::string(instance.param.name); });

// Every kind of light, and materials of every kind.
class PathSpaceLightTest : public testing::TestWithParam<Room> {};

TEST_P(PathSpaceLightTest, givesTheImageOfBidirectionalPathTracing) {
  Room room = GetParam();
  room.width = kWidth;
  room.height = kHeight;
  const Scene scene = roomScene(room);
  RenderSettings chosen = metropolis(MetropolisVariant::pathspace), other = defaults();
  chosen.metropolis.directPass = false;
  other.method = Method::bpt;
  expectSameTruth(renderSeeds(scene, chosen, samples(96, 24)), renderSeeds(scene, other, samples(96, 24), 2000),
                  "room");
}

INSTANTIATE_TEST_SUITE_P(Engine, PathSpaceLightTest, testing::ValuesIn([] {
                           std::vector<Room> rooms;
                           for (size_t light = 0; light < kRoomLightNames.size(); ++light) {
                             const bool mixed = light % 2 == 0;
                             rooms.push_back({.light = static_cast<RoomLight>(light),
                                              .materials = mixed ? RoomMaterials::mixed : RoomMaterials::rough,
                                              .tiltedNormals = mixed});
                           }
                           return rooms;
                         }()),
                         [](const auto& instance) {
                           return std::string(kRoomLightNames[static_cast<size_t>(instance.param.light)]);
                         });

}  // namespace
}  // namespace wavecrest
