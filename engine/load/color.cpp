#include "engine/load/color.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/load/cie_tables.h"
#include "engine/load/input_file.h"
#include "engine/load/parameters.h"
#include "engine/load/transform.h"
#include "engine/load/values.h"

namespace wavecrest {

namespace {

// XYZ to linear Rec. 709 with a D65 white point.
Rgb xyzToRgb(const Rgb& xyz) {
  constexpr double kMatrix[3][3] = {
      {3.240479, -1.537150, -0.498535}, {-0.969256, 1.875991, 0.041556}, {0.055648, -0.204043, 1.057311}};
  Rgb rgb{};
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) rgb[i] += kMatrix[i][j] * xyz[j];
  }
  return rgb;
}

Rgb grey(double value) { return {value, value, value}; }
Rgb scaled(double factor, const Rgb& color) { return {factor * color[0], factor * color[1], factor * color[2]}; }

// A spectrum of one value everywhere. As emission it has the colour of illuminant E, but in files of 0.4 to 0.6 it is
// R = G = B.
Rgb uniformSpectrum(double value, ColorRole role, bool legacy) {
  return role == ColorRole::emission && !legacy ? scaled(value, xyzToRgb({1, 1, 1})) : grey(value);
}

// One number (grey) or three.
Rgb readRgbNumbers(std::string_view text, const SourceLocation& where) {
  const std::vector<double> values = parseReals(text, where);
  if (values.size() == 1) return grey(values[0]);
  if (values.size() == 3) return {values[0], values[1], values[2]};
  throw LoadError(where, std::to_string(values.size()) + " numbers in <rgb>; expected 1 or 3");
}

// The value of a digit in lower case; -1 if it is no digit.
int hexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return -1;
}

bool isHexCode(std::string_view text) { return !text.empty() && text[0] == '#'; }

// "#rrggbb" as it stands, from 0 to 1.
Rgb readHexCode(std::string_view text, const SourceLocation& where) {
  const std::string digits = toLower(text.substr(1));
  const bool valid =
      digits.size() == 6 && std::all_of(digits.begin(), digits.end(), [](char c) { return hexDigit(c) >= 0; });
  if (!valid) throw LoadError(where, "bad colour " + inQuotes(text) + "; expected #rrggbb");
  Rgb code{};
  for (size_t i = 0; i < 3; ++i) code[i] = (16 * hexDigit(digits[2 * i]) + hexDigit(digits[2 * i + 1])) / 255.0;
  return code;
}

// "#rrggbb" or gamma-encoded numbers in [0, 1].
Rgb readSrgb(std::string_view text, const SourceLocation& where) {
  const Rgb encoded = isHexCode(text) ? readHexCode(text, where) : readRgbNumbers(text, where);
  Rgb linear{};
  for (size_t i = 0; i < 3; ++i) linear[i] = srgbToLinear(encoded[i]);
  return linear;
}

// Linear numbers, or "#rrggbb", which is gamma-encoded but in files of 0.4 to 0.6.
Rgb readRgb(std::string_view text, const SourceLocation& where, bool legacy) {
  if (!isHexCode(text)) return readRgbNumbers(text, where);
  return legacy ? readHexCode(text, where) : readSrgb(text, where);
}

// A piecewise linear spectrum as it stands in a file.
struct Spectrum {
  std::vector<double> wavelengths, values;

  // Interpolation needs at least two wavelengths in increasing order.
  Rgb toRgb(const SourceLocation& where, ColorRole role, bool legacy) const {
    for (size_t i = 1; i < wavelengths.size(); ++i) {
      if (wavelengths[i] > wavelengths[i - 1]) continue;
      throw LoadError(where, "wavelengths of a spectrum do not increase at " + std::to_string(wavelengths[i]) +
                                 "; expected them in increasing order");
    }
    if (wavelengths.size() < 2) {
      throw LoadError(where, "spectrum has too few entries; expected one value, or two wavelengths and their values");
    }
    return spectrumToRgb(wavelengths, values, role, legacy);
  }
};

// One value, or pairs "wavelength:value, …" in nm. Three numbers are an RGB colour.
Rgb readSpectrum(std::string_view text, const XmlElement& element, ColorRole role) {
  const SourceLocation where = element.location();
  const std::vector<std::string_view> tokens = splitTokens(text);
  if (tokens.size() == 1 && tokens[0].find(':') == std::string_view::npos) {
    return uniformSpectrum(parseReal(tokens[0], where), role, element.legacy);
  }
  if (tokens.size() == 3 && text.find(':') == std::string_view::npos)
    return readRgbNumbers(text, where);  // of version 0.6
  Spectrum spectrum;
  for (const std::string_view token : tokens) {
    const size_t colon = token.find(':');
    if (colon == std::string_view::npos) {
      throw LoadError(where, "bad entry " + inQuotes(token) + " of a spectrum; expected wavelength:value");
    }
    spectrum.wavelengths.push_back(parseReal(token.substr(0, colon), where));
    spectrum.values.push_back(parseReal(token.substr(colon + 1), where));
  }
  return spectrum.toRgb(where, role, element.legacy);
}

// A file with a wavelength and its value on each line; # begins a comment.
Rgb readSpectrumFile(LoadContext& context, const XmlElement& element, ColorRole role) {
  constexpr size_t kLargest = size_t{1} << 24;
  const std::filesystem::path path = context.resolvePath(element.get("filename"), element);
  const std::vector<char> bytes = readInputFile(path, element.location(), kLargest);
  SourceLocation line{path.string(), 0};
  Spectrum spectrum;
  for (std::string_view text(bytes.data(), bytes.size()); !text.empty();) {
    ++line.line;
    const size_t end = std::min(text.size(), text.find('\n'));
    const std::vector<double> numbers = parseReals(text.substr(0, std::min(end, text.find('#'))), line);
    text.remove_prefix(std::min(text.size(), end + 1));
    if (numbers.empty()) continue;
    if (numbers.size() != 2) throw LoadError(line, "bad line of a spectrum; expected a wavelength and a value");
    spectrum.wavelengths.push_back(numbers[0]);
    spectrum.values.push_back(numbers[1]);
  }
  return spectrum.toRgb({path.string(), 0}, role, element.legacy);
}

// Radiance of a black body (Planck's law) as Mitsuba has it: W / (m^2 sr nm), from `first` to `last` nm.
Rgb blackbody(double temperature, double first, double last, const XmlElement& element, ColorRole role) {
  const SourceLocation where = element.location();
  constexpr double kC = 2.99792458e8, kH = 6.62607004e-34, kBoltzmann = 1.38064852e-23;
  constexpr int kSteps = 1000;
  if (role == ColorRole::reflectance || role == ColorRole::refraction) {
    throw LoadError(where, "blackbody spectrum for what does not emit; expected it for a light");
  }
  if (!(temperature > 0)) throw LoadError(where, "temperature is not positive; expected kelvins above 0");
  Spectrum spectrum;
  for (int i = 0; i <= kSteps; ++i) {
    const double nm = first + (last - first) * i / kSteps, m = nm * 1e-9;
    spectrum.wavelengths.push_back(nm);
    spectrum.values.push_back(1e-9 * 2 * kH * kC * kC /
                              (std::pow(m, 5) * std::expm1(kH * kC / (m * kBoltzmann * temperature))));
  }
  return spectrum.toRgb(where, role, element.legacy);
}

// <blackbody temperature="5000K" scale="…"/> of 0.5 and 0.6.
Rgb readBlackbody(const XmlElement& element, ColorRole role) {
  checkAttributes(element, {"name", "temperature", "scale"});
  std::string_view temperature = element.get("temperature");
  if (temperature.ends_with('K') || temperature.ends_with('k')) temperature.remove_suffix(1);
  const std::string* scale = element.find("scale");
  return scaled(scale ? parseReal(*scale, element.location()) : 1,
                blackbody(parseReal(temperature, element.location()), kCieFirst, kCieLast, element, role));
}

// <spectrum type="uniform|d65|srgb|regular|irregular|blackbody">
Rgb readSpectrumObject(LoadContext& context, const XmlElement& object, ColorRole role) {
  const ReadingGuard guard(context, object);
  Parameters parameters(context, object);
  const std::string_view type = object.get("type");
  const auto numbers = [&](const char* name) {
    return parseReals(parameters.requiredString(name), parameters.locationOf(name));
  };
  Rgb color = grey(1);
  if (type == "uniform") {
    color = grey(parameters.requiredReal("value"));
  } else if (type == "d65") {
    if (const XmlElement* value = parameters.element("color")) color = readColor(context, *value, ColorRole::emission);
    color = scaled(parameters.real("scale", 1), color);
  } else if (type == "srgb") {
    const XmlElement* value = parameters.element("color");
    if (!value) throw LoadError(object.location(), "spectrum \"srgb\" has no color; expected <rgb name=\"color\">");
    color = readColor(context, *value, parameters.boolean("unbounded", false) ? ColorRole::unbounded : role);
  } else if (type == "irregular" || type == "regular") {
    Spectrum spectrum{.wavelengths = {}, .values = numbers("values")};
    if (type == "irregular") {
      spectrum.wavelengths = numbers("wavelengths");
    } else {
      const double first = parameters.requiredReal("wavelength_min"), last = parameters.requiredReal("wavelength_max");
      const size_t count = spectrum.values.size();
      for (size_t i = 0; i < count; ++i) {
        spectrum.wavelengths.push_back(first +
                                       (last - first) * static_cast<double>(i) / static_cast<double>(count - 1));
      }
    }
    if (spectrum.wavelengths.size() != spectrum.values.size()) {
      throw LoadError(object.location(), "spectrum has " + std::to_string(spectrum.wavelengths.size()) +
                                             " wavelengths and " + std::to_string(spectrum.values.size()) +
                                             " values; expected as many of both");
    }
    color = spectrum.toRgb(object.location(), role, object.legacy);
  } else if (type == "blackbody") {
    color = blackbody(parameters.requiredReal("temperature"), parameters.real("wavelength_min", kCieFirst),
                      parameters.real("wavelength_max", kCieLast), object, role);
  } else {
    throw LoadError(object.location(),
                    "spectrum " + inQuotes(type) +
                        " is not supported; expected uniform, d65, srgb, regular, irregular or blackbody");
  }
  parameters.finish();
  return color;
}

// The colour of a value element or an object, whatever its range.
Rgb readAnyColor(LoadContext& context, const XmlElement& element, ColorRole role) {
  if (element.isObject() && element.tag == "spectrum") return readSpectrumObject(context, element, role);
  const SourceLocation where = element.location();
  if (element.tag == "blackbody") return readBlackbody(element, role);
  if (element.tag == "spectrum" && element.find("filename") != nullptr) {
    checkAttributes(element, {"name", "filename"});
    return readSpectrumFile(context, element, role);
  }
  const std::string* value = element.find("value");
  if (element.tag != "rgb" && element.tag != "srgb" && element.tag != "spectrum" && element.tag != "float" &&
      element.tag != "integer") {
    throw LoadError(where, "<" + element.tag + "> given for a colour; expected <rgb>, <srgb>, <spectrum> or <float>");
  }
  checkAttributes(element, {"name", "value"});
  if (!value) throw LoadError(where, "<" + element.tag + "> has no value; expected the attribute value");
  // Convert the value by its tag.
  if (element.tag == "rgb") return readRgb(*value, where, element.legacy);
  if (element.tag == "srgb") return readSrgb(*value, where);
  if (element.tag == "spectrum") return readSpectrum(*value, element, role);
  return grey(parseReal(*value, where));
}

}  // namespace

// The sRGB transfer function (IEC 61966-2-1).
double srgbToLinear(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

Rgb spectrumToRgb(std::span<const double> wavelengths, std::span<const double> values, ColorRole role, bool legacy) {
  // Mitsuba's quadrature: 1000 samples over the CIE range, both ends included.
  constexpr int kSteps = 1000;
  Rgb xyz{0, 0, 0};
  // Samples and wavelengths both increase, so the search for an interval continues at the previous one.
  size_t interval = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double w = kCieFirst + (kCieLast - kCieFirst) * i / (kSteps - 1);
    if (w < wavelengths.front() || w > wavelengths.back()) continue;
    while (interval + 2 < wavelengths.size() && wavelengths[interval + 1] <= w) ++interval;
    const double t = (w - wavelengths[interval]) / (wavelengths[interval + 1] - wavelengths[interval]);
    double value = (1 - t) * values[interval] + t * values[interval + 1];
    // Everything but emission is seen under D65. Mitsuba 0.6 has no illuminant.
    if (role != ColorRole::emission && !legacy) value *= cieD65(w);
    const std::array<double, 3> observer = cie1931(w);
    for (size_t c = 0; c < 3; ++c) xyz[c] += observer[c] * value;
  }
  // Convert to RGB. Like Mitsuba, divide the range by the number of samples, not by that of the intervals.
  const double step = (kCieLast - kCieFirst) / kSteps;
  Rgb rgb = xyzToRgb(scaled(step, xyz));
  // Colours outside the gamut are clamped.
  const double highest = role == ColorRole::reflectance ? 1.0 : std::numeric_limits<double>::max();
  for (double& channel : rgb) channel = std::clamp(channel, 0.0, highest);
  return rgb;
}

Rgb readColor(LoadContext& context, const XmlElement& element, ColorRole role) {
  Rgb color = readAnyColor(context, element, role);
  // Check the range that the role allows. As in Mitsuba, an object may reflect more light than arrives.
  const SourceLocation where = element.location();
  const bool atMost1 = role == ColorRole::reflectance && !element.isObject();
  const double most = atMost1 ? 1.0 : double{std::numeric_limits<float>::max()};
  constexpr double kSlightlyBelow = -0.1;
  for (double& channel : color) {
    if (role == ColorRole::refraction && channel < 0 && channel >= kSlightlyBelow) {
      context.note(where, "index of refraction below 0", "0 is used");
      channel = 0;
    }
    // NaN fails both comparisons.
    if (!(channel >= 0 && channel <= most)) {
      const std::string* value = element.find("value");
      throw LoadError(where, "colour " + (value ? inQuotes(*value) : "of a <" + element.tag + ">") +
                                 " is out of range; expected values from 0 to " + (atMost1 ? "1" : "3.4e38"));
    }
  }
  return color;
}

}  // namespace wavecrest
