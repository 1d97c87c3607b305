// Energy is that of the packages, each counted once.
#include "bench/machine/energy.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <optional>
#include <string>

#include "tests/metrics/temporary_folder.h"

namespace wavecrest {
namespace {

class EnergyTest : public testing::Test {
 protected:
  // A zone of the power capping interface; without energy: a file that this user may not read.
  void addZone(int number, const std::string& name, const std::string& microjoules) const {
    const std::string zone = "intel-rapl:" + std::to_string(number);
    std::filesystem::create_directories(zones_.folder() / zone);
    zones_.write(zone + "/name", name + "\n");
    if (!microjoules.empty()) zones_.write(zone + "/energy_uj", microjoules + "\n");
  }
  std::optional<double> joules() const { return packageJoules(zones_.folder().string()); }

 private:
  const test::TemporaryFolder zones_;
};

TEST_F(EnergyTest, isTheSumOfPackagesWithoutTheBoard) {
  EXPECT_FALSE(joules());
  addZone(0, "package-0", "2000000");
  addZone(1, "psys", "9000000");
  addZone(2, "package-1", "3000000");
  EXPECT_DOUBLE_EQ(joules().value(), 5);
}

TEST_F(EnergyTest, isUnknownWhereAPackageDoesNotTell) {
  addZone(0, "package-0", "2000000");
  addZone(1, "package-1", "");
  EXPECT_FALSE(joules());
}

TEST_F(EnergyTest, isUnknownWithoutPackages) {
  addZone(0, "psys", "9000000");
  EXPECT_FALSE(joules());
}

}  // namespace
}  // namespace wavecrest
