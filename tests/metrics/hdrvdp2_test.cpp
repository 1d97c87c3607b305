#include "metrics/hdrvdp2/hdrvdp2.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "tests/metrics/golden.h"

namespace wavecrest {
namespace {

// Two orders tighter than the score needs: single precision in filters moves Q by less than 1e-6.
constexpr double kQTolerance = 1e-6, kMosTolerance = 1e-4;

TEST(HdrVdp2, MatchesGoldenScoresOfAllPairsOnEveryIsa) {
  for (const Isa isa : availableIsas()) {
    for (const auto& pair : test::goldenPairs()) {
      if (isa != bestIsa() && pair.test.width > 512) continue;  // the largest pair adds nothing but time
      SCOPED_TRACE(pair.name + " " + std::string(toString(isa)));
      const auto figures = test::goldenFigures("hdrvdp2.json", pair.name);
      const HdrVdp2Result result = PreparedHdrVdp2(pair.reference, isa).compare(pair.test);
      EXPECT_NEAR(result.q, figures["Q"], kQTolerance);
      EXPECT_NEAR(result.qMos, figures["Q_MOS"], kMosTolerance);
    }
  }
}

}  // namespace
}  // namespace wavecrest
