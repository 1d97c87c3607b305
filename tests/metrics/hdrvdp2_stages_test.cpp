// The building blocks of HDR-VDP-2 against vectors from the original program (golden/hdrvdp2_primitives.json) and its
// intermediate figures for the golden pairs (golden/hdrvdp2.json).
#include <gtest/gtest.h>

#include <numeric>

#include "metrics/hdrvdp2/analysis.h"
#include "metrics/hdrvdp2/hdrvdp2.h"
#include "metrics/hdrvdp2/model.h"
#include "metrics/hdrvdp2/resize.h"
#include "tests/metrics/golden.h"
#include "tests/metrics/golden_json.h"

namespace wavecrest::vdp {
namespace {

nlohmann::json primitives(const char* part) { return test::goldenJson("hdrvdp2_primitives.json")[part]; }

void expectRelative(double actual, double expected, double tolerance) {
  EXPECT_NEAR(actual, expected, tolerance * std::max(std::abs(expected), 1e-6));
}

TEST(HdrVdp2Model, ResponseTablesMatch) {
  const auto golden = primitives("lut");
  const ResponseTables tables = makeResponseTables();
  for (size_t i = 0; i < golden["node"].size(); ++i) {
    const size_t node = golden["node"][i];
    expectRelative(tables.cone[node], golden["J_cone"][i], 1e-11);
    expectRelative(tables.rod[node], golden["J_rod"][i], 1e-11);
  }
}

TEST(HdrVdp2Model, OpticalTransferMatches) {
  const auto golden = primitives("mtf");
  for (size_t i = 0; i < golden["rho"].size(); ++i)
    expectRelative(opticalTransfer(golden["rho"][i]), golden["value"][i], 1e-11);
}

TEST(HdrVdp2Model, ContrastSensitivityMatches) {
  const auto golden = primitives("csf");
  for (size_t f = 0; f < golden["freq"].size(); ++f)
    for (size_t l = 0; l < golden["lum"].size(); ++l)
      expectRelative(contrastSensitivity(golden["freq"][f], golden["lum"][l]), golden["S_rows_freq_cols_lum"][f][l],
                     1e-11);
}

TEST(HdrVdp2Resize, MatchesWithoutNormalisation) {
  const auto golden = primitives("resize");
  const std::vector<double> input = golden["input7"];
  for (const auto& [length, name] :
       {std::pair{4u, "rows7_to_4"}, {14u, "rows7_to_14"}, {13u, "rows7_to_13"}, {2u, "rows7_to_2"}}) {
    const ResizeTable table(7, length);
    for (size_t i = 0; i < length; ++i) {
      double byOutput = 0, byTap = 0;
      for (size_t t = 0; t < table.taps; ++t) {
        byOutput += double{table.weightByOutput[i * table.taps + t]} * input[table.indexByOutput[i * table.taps + t]];
        byTap += double{table.weightByTap[t * table.stride + i]} * input[table.indexByTap[t * table.stride + i]];
      }
      EXPECT_NEAR(byOutput, golden[name][i], 2e-6) << name << " " << i;
      EXPECT_NEAR(byTap, golden[name][i], 2e-6) << name << " " << i;
    }
  }
}

TEST(HdrVdp2Fourier, FilterMatchesOnAPaddedTorus) {
  const auto golden = primitives("fourier");
  Plane plane(4, 3);
  for (size_t i = 0; i < 12; ++i) plane.row(i / 4)[i % 4] = golden["input"][i];
  const FourierFilter filter(4, 3);
  auto spectra = filter.makeSpectra(1);
  const FourierFilterJob job{&plane, &plane, 1e-5};
  filter.apply(filter.sampleGain(kPixelsPerDegree, opticalTransfer), {&job, 1}, spectra);
  for (size_t i = 0; i < 12; ++i) EXPECT_NEAR(plane.row(i / 4)[i % 4], golden["output"][i], 5e-6) << i;
}

void expectPlane(const Plane& plane, const nlohmann::json& golden) {
  double sum = 0, absoluteSum = 0;
  for (size_t y = 0; y < plane.height(); ++y)
    for (size_t x = 0; x < plane.width(); ++x) {
      sum += double{plane.row(y)[x]};
      absoluteSum += std::abs(double{plane.row(y)[x]});
    }
  EXPECT_NEAR(sum, golden["sum"], 2e-4);
  EXPECT_NEAR(absoluteSum, golden["abs_sum"], 2e-4);
  EXPECT_NEAR(plane.row(0)[0], golden["y0x0"], 4e-6);
  EXPECT_NEAR(plane.row(0)[1], golden["y0x1"], 4e-6);
  EXPECT_NEAR(plane.row(1)[0], golden["y1x0"], 4e-6);
  EXPECT_NEAR(plane.row(3)[5], golden["y3x5"], 4e-6);
  EXPECT_NEAR(plane.row(plane.height() - 1)[plane.width() - 1], golden["last"], 4e-6);
}

TEST(HdrVdp2Pyramid, FirstFiltersMatchWithMirroredEdges) {
  const auto golden = primitives("corr");
  for (const Isa isa : availableIsas()) {
    SCOPED_TRACE(toString(isa));
    const SteerablePyramid pyramid(19, 18, isa);
    Plane input(19, 18, SteerablePyramid::kInputBorder);
    for (size_t y = 0; y < 18; ++y)
      for (size_t x = 0; x < 19; ++x) input.row(y)[x] = static_cast<float>((7 * x + 13 * y + x * y) % 11) - 5;
    auto bands = pyramid.makeBands();
    auto workspace = pyramid.makeWorkspace();
    pyramid.decompose(input, bands, workspace);
    expectPlane(bands[0].planes[0], golden["hi0"]);
    expectPlane(workspace.lowPass[0], golden["lo0"]);
  }
}

TEST(HdrVdp2Pyramid, SizesAreHalvedUpwardsAndLevelsCountedDownwards) {
  const SteerablePyramid pyramid(333, 217, bestIsa());
  EXPECT_EQ(pyramid.levels(), 4u);
  const auto& sizes = pyramid.bandSizes();
  ASSERT_EQ(sizes.size(), 6u);
  EXPECT_EQ(sizes[2].width, 167u);
  EXPECT_EQ(sizes[2].height, 109u);
  EXPECT_EQ(sizes[5].width, 21u);
  EXPECT_EQ(sizes[5].height, 14u);
}

// The filters are nearly self-inverting: what decompose takes apart, reconstruct puts together again.
TEST(HdrVdp2Pyramid, ReconstructionRestoresTheInput) {
  const SteerablePyramid pyramid(75, 50, bestIsa());
  Plane input(75, 50, SteerablePyramid::kInputBorder);
  for (size_t y = 0; y < 50; ++y)
    for (size_t x = 0; x < 75; ++x)
      input.row(y)[x] = std::sin(0.3f * static_cast<float>(x)) * 20 + static_cast<float>((x / 9 + y / 6) % 2) * 30;
  auto bands = pyramid.makeBands();
  auto workspace = pyramid.makeWorkspace();
  pyramid.decompose(input, bands, workspace);
  const Plane output = pyramid.reconstruct(bands);
  double worst = 0;
  for (size_t y = 0; y < 50; ++y)
    for (size_t x = 0; x < 75; ++x)
      worst = std::max(worst, std::abs(double{output.row(y)[x]} - double{input.row(y)[x]}));
  EXPECT_LT(worst, 3.5) << "of a range of 70, at the corners of the checkers";
}

TEST(HdrVdp2Analysis, MatchesTheOriginalsIntermediateFigures) {
  for (const auto& pair : test::goldenPairs()) {
    SCOPED_TRACE(pair.name);
    const auto golden = test::goldenFigures("hdrvdp2.json", pair.name)["reference"];
    const Image8& image = pair.reference;
    const Analyzer analyzer(image.width, image.height, bestIsa());
    auto workspace = analyzer.makeWorkspace();
    Analysis analysis = analyzer.makeAnalysis();
    analyzer.analyze(image, std::nullopt, analysis, workspace);
    EXPECT_NEAR(analysis.basePad, golden["base_pad_value"], 2e-4);  // a mean of values of the order of 100
    expectRelative(analysis.adaptation.row(0)[0], golden["L_adapt_top_left"], 1e-5);
    size_t index = 0;
    for (const Band& band : analysis.bands) {
      for (size_t o = 0; o < band.orientations; ++o, ++index) {
        const Plane& plane = band.planes[o];
        double sum = 0;
        for (size_t y = 0; y < plane.height(); ++y)
          for (size_t x = 0; x < plane.width(); ++x) sum += std::abs(double{plane.row(y)[x]});
        SCOPED_TRACE(index);
        expectRelative(sum, golden["band_abs_sum"][index], 2e-5);
      }
    }
    EXPECT_EQ(index, golden["band_abs_sum"].size());
  }
}

TEST(HdrVdp2Masking, EveryBandsErrorMatches) {
  for (const auto& pair : test::goldenPairs()) {
    SCOPED_TRACE(pair.name);
    const auto golden = test::goldenFigures("hdrvdp2.json", pair.name)["bands"];
    std::vector<HdrVdp2Band> bands;
    PreparedHdrVdp2(pair.reference).compare(pair.test, false, &bands);
    ASSERT_EQ(bands.size(), golden.size());
    for (size_t i = 0; i < bands.size(); ++i) {
      SCOPED_TRACE(i);
      expectRelative(bands[i].weight, golden[i]["w"], 1e-9);
      expectRelative(bands[i].error, golden[i]["E"], 1e-4);  // 1e-4 in ln E moves Q by 3e-6 at most
    }
  }
}

}  // namespace
}  // namespace wavecrest::vdp
