// Every stage of every instruction set, precision and specialisation, with its contracts checked before and after it: a
// broken one ends the program.
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "engine/walks/stage_contracts.h"
#include "tests/engine/light_scenes.h"
#include "tests/engine/render_statistics.h"

namespace wavecrest {
namespace {

RenderSettings settingsOf(Method method, Precision precision, Isa isa) {
  RenderSettings settings;
  settings.method = method;
  settings.precision = precision;
  settings.isa = isa;
  settings.limits = pathLimits(-1, 3);
  settings.waveSize = 100;  // no multiple of a block, and not all waves are full
  settings.metropolis.chains = 150;
  settings.metropolis.bootstrapSamples = 2048;
  return settings;
}

// Room by room: what each specialisation is for.
std::vector<Scene> scenes() {
  std::vector<Scene> list;
  for (const RoomMaterials materials : {RoomMaterials::diffuse, RoomMaterials::mixed, RoomMaterials::rough}) {
    for (const RoomLight light : {RoomLight::quad, RoomLight::sphere, RoomLight::envmap}) {
      list.push_back(roomScene({.light = light,
                                .materials = materials,
                                .tiltedNormals = light == RoomLight::envmap,
                                .width = 14,
                                .height = 9}));
    }
  }
  return list;
}

constexpr std::array kAccels{Accel::small, Accel::bvh, Accel::embree};

// An intersector changes extend and occlude alone: pt and bpt render each scene with all of them, the other methods
// with one that the scene's number chooses.
void renderByAll(const Scene& scene, size_t number, Precision precision, Isa isa) {
  for (const MethodEntry& entry : kMethods) {
    if (isChosenByTrials(entry.method)) continue;  // tries and renders by some of the others
    RenderSettings settings = settingsOf(entry.method, precision, isa);
    if (entry.method == Method::mlt) {
      for (const MetropolisVariant variant :
           {MetropolisVariant::pssmlt, MetropolisVariant::mmlt, MetropolisVariant::pathspace}) {
        settings.metropolis.variant = variant;
        render(scene, settings, 3);
      }
      continue;
    }
    const bool everyAccel = entry.method == Method::pt || entry.method == Method::bpt;
    for (size_t i = 0; i < kAccels.size(); ++i) {
      // Each intersector meets all materials and all lights.
      if (!everyAccel && i != (number + number / kAccels.size()) % kAccels.size()) continue;
      settings.accel = kAccels[i];
      render(scene, settings, 3);
    }
  }
}

class ContractsTest : public testing::TestWithParam<Isa> {
 protected:
  ContractsTest() { checksContracts = true; }
  ~ContractsTest() override { checksContracts = false; }
};
TEST_P(ContractsTest, areKeptByEveryKernel) {
  std::vector<Scene> list = scenes();
  list.push_back(wideGamutScene(false, 14, 9));
  for (size_t number = 0; number < list.size(); ++number) {
    for (const Precision precision : {Precision::floating, Precision::doubled}) {
      renderByAll(list[number], number, precision, GetParam());
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Engine, ContractsTest, testing::ValuesIn(availableIsas()),
                         [](const auto& instance) { return std::string(toString(instance.param)); });

}  // namespace
}  // namespace wavecrest
