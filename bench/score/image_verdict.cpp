#include "bench/score/image_verdict.h"

#include <fmt/format.h>

#include "bench/enumerator_name.h"

namespace wavecrest {
namespace {

ImageVerdict& conclude(ImageVerdict& verdict, Validity validity, const std::string& reason = {}) {
  verdict.validity = validity;
  verdict.text = enumeratorName(kValidityNames, validity);
  if (!reason.empty()) verdict.text += fmt::format(" ({})", reason);
  return verdict;
}

}  // namespace

ImageVerdict judgeImage(const Image& film, ScoreSize size, Isa isa, const ScoreEntry& entry,
                        const ExpectedImages& expected, const std::string& build) {
  ImageVerdict verdict{.hash = hashImage(film.pixels), .difference = {}, .text = {}};
  // The bits, where they are known. Those of another build may differ by rounding.
  const std::string group = hashGroup(isa);
  if (const std::optional<uint64_t> hash = expected.hashes.find(size, group, entry)) {
    if (*hash == verdict.hash) return conclude(verdict, Validity::exact);
    const std::string& maker = expected.hashes.buildOf(size, group);
    if (maker.empty() || maker == build) {
      return conclude(verdict, Validity::refused, "other bits than those that are known of this build");
    }
  }
  // The picture.
  const ScorePicture* picture = expected.pictures.find(size, entry);
  if (picture == nullptr) return conclude(verdict, Validity::unknown, "no picture of it is known");
  verdict.difference = differenceOf(pictureOf(film), *picture);
  const PictureTolerance tolerance = toleranceOf(entry.method);
  if (isWithin(*verdict.difference, tolerance)) {
    return conclude(verdict, Validity::tolerated, toText(*verdict.difference));
  }
  return conclude(verdict, Validity::refused, whatExceeds(*verdict.difference, tolerance));
}

}  // namespace wavecrest
