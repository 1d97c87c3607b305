// Elementary functions against long double over their whole ranges: the error bounds that kernels/simd/math.h states.
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "tests/effort.h"
#include "tests/kernels/isa_test.h"
#include "tests/kernels/math_entries.h"

namespace wavecrest {
namespace {

using Long = long double;
constexpr Long kLongPi = 3.14159265358979323846264338327950288L;

// A range of arguments, evenly spread, or evenly spread in magnitude (the logarithm) between low and high.
struct Range {
  double low, high;
  bool magnitudes = false;
};

// ulp: relative to the spacing of the format at the reference value. absolute: in units of the spacing at 1.
// scaled: in ulp, divided by 1 + |b log2 a|, for powers.
enum class Measure { ulp, absolute, scaled };

struct Case {
  const char* name;
  std::function<Long(Long, Long)> reference;
  Measure measure;
  double floatBound, doubleBound;  // doubleBound 0: Float only
  Range floatRange, doubleRange;   // of a
  Range secondRange = {0, 1};      // of b
};

const Case kCases[] = {
    {"sinFirstOctant",
     [](Long a, Long) { return std::sin(a); },
     Measure::ulp,
     1.3,
     1.3,
     {-0.785398, 0.785398},
     {-0.785398, 0.785398}},
    {"cosFirstOctant",
     [](Long a, Long) { return std::cos(a); },
     Measure::ulp,
     1.3,
     1.3,
     {-0.785398, 0.785398},
     {-0.785398, 0.785398}},
    {"sin2Pi", [](Long a, Long) { return std::sin(2 * kLongPi * a); }, Measure::absolute, 1, 1, {0, 1}, {0, 1}},
    {"cos2Pi", [](Long a, Long) { return std::cos(2 * kLongPi * a); }, Measure::absolute, 1, 1, {0, 1}, {0, 1}},
    {"sin", [](Long a, Long) { return std::sin(a); }, Measure::absolute, 1, 1, {-8192, 8192}, {-1e6, 1e6}},
    {"cos", [](Long a, Long) { return std::cos(a); }, Measure::absolute, 1, 1, {-8192, 8192}, {-1e6, 1e6}},
    {"log", [](Long a, Long) { return std::log(a); }, Measure::ulp, 1, 1, {1e-37, 1e38, true}, {1e-300, 1e300, true}},
    {"log", [](Long a, Long) { return std::log(a); }, Measure::ulp, 1, 1, {0.5, 2}, {0.5, 2}},
    {"log2", [](Long a, Long) { return std::log2(a); }, Measure::ulp, 2, 2, {1e-37, 1e38, true}, {1e-300, 1e300, true}},
    {"log2", [](Long a, Long) { return std::log2(a); }, Measure::ulp, 2, 2, {0.5, 2}, {0.5, 2}},
    {"log1p", [](Long a, Long) { return std::log1p(a); }, Measure::ulp, 2.5, 2.5, {-0.99, 1}, {-0.99, 1}},
    {"log1p",
     [](Long a, Long) { return std::log1p(a); },
     Measure::ulp,
     2.5,
     2.5,
     {1e-30, 1e30, true},
     {1e-200, 1e200, true}},
    {"exp", [](Long a, Long) { return std::exp(a); }, Measure::ulp, 1, 1, {-87, 88}, {-700, 700}},
    {"expm1", [](Long a, Long) { return std::expm1(a); }, Measure::ulp, 4, 4, {-87, 88}, {-700, 700}},
    {"expm1", [](Long a, Long) { return std::expm1(a); }, Measure::ulp, 4, 4, {-1, 1}, {-1, 1}},
    {"exp2", [](Long a, Long) { return std::exp2(a); }, Measure::ulp, 1.2, 1.2, {-126, 127.4}, {-1022, 1023.4}},
    {"acos", [](Long a, Long) { return std::acos(a); }, Measure::ulp, 1.5, 1.5, {-1, 1}, {-1, 1}},
    {"acos", [](Long a, Long) { return std::acos(a); }, Measure::ulp, 1.5, 1.5, {0.999, 1}, {0.999, 1}},
    {"atan", [](Long a, Long) { return std::atan(a); }, Measure::ulp, 2.5, 2.5, {-20, 20}, {-20, 20}},
    {"atan",
     [](Long a, Long) { return std::atan(a); },
     Measure::ulp,
     2.5,
     2.5,
     {1e-30, 1e30, true},
     {1e-200, 1e200, true}},
    {"atan2", [](Long a, Long b) { return std::atan2(a, b); }, Measure::ulp, 2.5, 2.5, {-1, 1}, {-1, 1}, {-1, 1}},
    {"pow",
     [](Long a, Long b) { return std::pow(a, b); },
     Measure::scaled,
     2,
     2,
     {1e-4, 1, true},
     {1e-4, 1, true},
     {0, 9}},
    {"pow",
     [](Long a, Long b) { return std::pow(a, b); },
     Measure::scaled,
     2,
     2,
     {0.99, 1.01},
     {0.99, 1.01},
     {0, 5000}},
};

template <class T>
std::vector<T> arguments(Range range, size_t count, unsigned seed) {
  std::mt19937_64 random(seed);
  const bool logs = range.magnitudes;
  std::uniform_real_distribution<double> uniform(logs ? std::log(range.low) : range.low,
                                                 logs ? std::log(range.high) : range.high);
  std::vector<T> values{static_cast<T>(range.low), static_cast<T>(range.high)};
  while (values.size() < count) {
    const double x = uniform(random);
    values.push_back(static_cast<T>(logs ? std::exp(x) : x));
  }
  return values;
}

template <class T>
double errorOf(Measure measure, Long expected, T actual, T a, T b) {
  const Long epsilon = std::numeric_limits<T>::epsilon();
  const Long difference = std::abs(static_cast<Long>(actual) - expected);
  if (measure == Measure::absolute) return static_cast<double>(difference / epsilon);
  const Long spacing = std::ldexp(epsilon, std::ilogb(expected));
  const double ulps =
      static_cast<double>(difference / std::max(spacing, static_cast<Long>(std::numeric_limits<T>::denorm_min())));
  if (measure == Measure::ulp) return ulps;
  return ulps / (1 + std::abs(static_cast<double>(b) * std::log2(static_cast<double>(a))));
}

class MathTest : public IsaTest {
 protected:
  template <class T>
  void checkCase(const Case& test, std::span<const MathFunction<T>> functions, Range range, double bound) {
    const auto function = std::find_if(functions.begin(), functions.end(),
                                       [&](const auto& f) { return std::string_view(f.name) == test.name; });
    ASSERT_NE(function, functions.end()) << test.name;
    constexpr size_t kCount = effort(1 << 16, 1 << 11);
    const std::vector<T> a = arguments<T>(range, kCount, 1), b = arguments<T>(test.secondRange, kCount, 2);
    std::vector<T> out(kCount);
    function->run(a.data(), b.data(), out.data(), kCount);
    double worst = 0;
    size_t worstAt = 0;
    for (size_t i = 0; i < kCount; ++i) {
      const double error = errorOf(test.measure, test.reference(a[i], b[i]), out[i], a[i], b[i]);
      if (!(error <= worst)) {
        worst = error;
        worstAt = i;
      }
    }
    RecordProperty(std::string(test.name) + (sizeof(T) == 4 ? "_float" : "_double"), std::to_string(worst));
    EXPECT_LE(worst, bound) << test.name << " at a " << a[worstAt] << " b " << b[worstAt] << ": " << out[worstAt];
  }
};
WAVECREST_TEST_EVERY_ISA(MathTest);

TEST_P(MathTest, floatErrorsStayWithinTheStatedBounds) {
  const auto functions = entries<MathEntries>().floats;
  for (const Case& test : kCases) checkCase<float>(test, functions, test.floatRange, test.floatBound);
}

TEST_P(MathTest, doubleErrorsStayWithinTheStatedBounds) {
  const auto functions = entries<MathEntries>().doubles;
  for (const Case& test : kCases) {
    if (test.doubleBound > 0) checkCase<double>(test, functions, test.doubleRange, test.doubleBound);
  }
}

// Values at the ends and corners of the domains.
template <class T>
void checkExactValues(const MathEntries& entries, std::span<const MathFunction<T>> functions) {
  const auto value = [&](std::string_view name, T a, T b = 0) {
    const auto function =
        std::find_if(functions.begin(), functions.end(), [&](const auto& f) { return f.name == name; });
    std::vector<T> as(entries.lanes, a), bs(entries.lanes, b), out(entries.lanes);
    function->run(as.data(), bs.data(), out.data(), entries.lanes);
    return out.back();
  };
  for (const T quarter : {T(0), T(0.25), T(0.5), T(0.75), T(1)}) {
    EXPECT_EQ(value("sin2Pi", quarter), std::round(std::sin(2 * static_cast<T>(kLongPi) * quarter)));
    EXPECT_EQ(value("cos2Pi", quarter), std::round(std::cos(2 * static_cast<T>(kLongPi) * quarter)));
  }
  EXPECT_EQ(value("sin", 0), T(0));
  EXPECT_EQ(value("cos", 0), T(1));
  EXPECT_EQ(value("log", 1), T(0));
  EXPECT_EQ(value("exp", 0), T(1));
  EXPECT_EQ(value("exp", -10000), T(0));
  for (const int n : {-126, -1, 0, 1, 10, 127}) EXPECT_EQ(value("exp2", static_cast<T>(n)), std::ldexp(T(1), n));
  EXPECT_EQ(value("exp2", T(-2000)), T(0));
  EXPECT_EQ(value("exp2", T(2000)), std::numeric_limits<T>::infinity());
  EXPECT_EQ(value("acos", 1), T(0));
  EXPECT_EQ(value("atan2", 0, 0), T(0));
  EXPECT_EQ(value("atan2", 0, 1), T(0));
  EXPECT_EQ(value("atan2", 0, -1), static_cast<T>(kLongPi));
  EXPECT_EQ(value("atan2", 1, 0), static_cast<T>(kLongPi / 2));
  EXPECT_EQ(value("atan2", -1, 0), static_cast<T>(-kLongPi / 2));
  EXPECT_EQ(value("pow", 0, 2), T(0));
  EXPECT_EQ(value("pow", 0, 0), T(1));
  EXPECT_EQ(value("pow", 1, 1000000), T(1));
}

TEST_P(MathTest, cornersHaveTheirExactValues) {
  const MathEntries& functions = entries<MathEntries>();
  checkExactValues<float>(functions, functions.floats);
  checkExactValues<double>(functions, functions.doubles);
}

}  // namespace
}  // namespace wavecrest
