// The number scanner of mesh files against strtof.
#include "engine/load/text_scanner.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>
#include <string>

#include "engine/load/values.h"

namespace wavecrest {
namespace {

float scan(const std::string& text) {
  const std::string line = text + "\n";
  TextScanner scanner(line, "test");
  return scanner.readFloat("a number");
}

TEST(TextScanner, ReadsTheUsualForms) {
  for (const char* text :
       {"0", "-0", "1", "+1", "-1.5", ".5", "5.", "1e3", "1E-3", "1.25e+2", "0.1", "123456789.987654321",
        "3.4028234e38", "1e-40", "0.000000000000000000000000001", "12345678901234567890123", "9e22", "-7e-22"}) {
    EXPECT_EQ(scan(text), std::strtof(text, nullptr)) << text;
  }
}

TEST(TextScanner, AgreesWithStrtofOnRandomNumbers) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> exponent(-38, 38);
  std::uniform_int_distribution<int> digits(1, 20);
  for (int i = 0; i < 100000; ++i) {
    char text[64];
    const double value = (i % 2 ? -1 : 1) * std::pow(10.0, exponent(random));
    std::snprintf(text, sizeof text, i % 3 ? "%.*g" : "%.*e", digits(random), value);
    // Rounded by way of double: in rare cases one ulp beside strtof, which rounds once.
    EXPECT_FLOAT_EQ(scan(text), std::strtof(text, nullptr)) << text;
  }
}

TEST(TextScanner, RefusesWhatIsNoNumber) {
  for (const char* text : {"-", ".", "e5", "1e", "1e+", "1..2", "1x", "nan", "inf", "1e39", "-1e400", "0x10"}) {
    EXPECT_THROW(scan(text), LoadError) << text;
  }
}

TEST(TextScanner, UnderflowIsZero) { EXPECT_EQ(scan("1e-400"), 0); }

TEST(TextScanner, IntegersAndLines) {
  const std::string text = "1 -22\n\n  333 x\n";
  TextScanner scanner(text, "file");
  EXPECT_EQ(scanner.readInteger("an integer"), 1);
  EXPECT_EQ(scanner.readInteger("an integer"), -22);
  EXPECT_EQ(scanner.readInteger("an integer"), 333);
  try {
    scanner.readInteger("an integer");
    FAIL();
  } catch (const LoadError& error) {
    EXPECT_STREQ(error.what(), "file:3: bad integer \"x\"; expected an integer");
  }
}

TEST(TextScanner, SkipsAnythingInThePlaceOfANumber) {
  const std::string text = " nan\n7 x\n";
  TextScanner scanner(text, "file");
  scanner.skipToken("a number");
  EXPECT_EQ(scanner.readInteger("an integer"), 7);
  scanner.skipToken("a number");
  EXPECT_THROW(scanner.skipToken("a number"), LoadError);
}

TEST(Quotes, endBetweenCharactersOfUtf8) {
  const std::string most(58, 'a');
  EXPECT_EQ(inQuotes(most + "ü"), "\"" + most + "ü\"");
  EXPECT_EQ(inQuotes(most + "aü"), "\"" + most + "a…\"");
  EXPECT_EQ(inQuotes(most + "üb"), "\"" + most + "ü…\"");
  EXPECT_EQ(inQuotes(std::string(61, '\x80')), "\"…\"") << "no UTF-8";
}

}  // namespace
}  // namespace wavecrest
