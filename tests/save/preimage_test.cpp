// Numbers that round to a wanted result: found for what the loader's arithmetic made of other numbers.
#include "engine/save/preimage.h"

#include <gtest/gtest.h>

#include <random>

#include "engine/scene/vector_math.h"

namespace wavecrest {
namespace {

constexpr int kCases = 2000;

TEST(Preimage, ASumThatWasRoundedTwiceIsFound) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> number(-1, 1), magnitude(-12, 12);
  for (int i = 0; i < kCases; ++i) {
    const double a = number(random) * std::exp2(magnitude(random)), b = number(random) * std::exp2(magnitude(random));
    const auto f = [&](double x) { return (a + x) + b; };
    const double target = f(number(random) * std::exp2(magnitude(random)));
    EXPECT_EQ(f(sumPreimage(target, f)), target) << a << " " << b;
  }
}

TEST(Preimage, AProductIsFound) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> number(0.01, 100);
  for (int i = 0; i < kCases; ++i) {
    const double factor = number(random);
    const auto f = [&](double x) { return x * factor; };
    const double target = f(number(random));
    EXPECT_EQ(f(productPreimage(target, f)), target) << factor;
  }
}

TEST(Preimage, AUnitVectorIsFoundAndLittleLonger) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> number;
  const auto unit = [](const Double3& v) { return (1 / length(v)) * v; };
  for (int i = 0; i < kCases; ++i) {
    const Double3 wanted = unit({number(random), number(random), number(random)});
    const Double3 found = unitPreimage(wanted, 1.0 / 2048, unit);
    EXPECT_EQ(unit(found), wanted);
    EXPECT_LE(length(found), 1.126);
  }
}

}  // namespace
}  // namespace wavecrest
