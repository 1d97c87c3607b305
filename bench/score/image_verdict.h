// Whether an image is the one that an entry of the workload renders: by its bits where they are known, else by how far
// its picture is from the expected one.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "bench/score/expected.h"
#include "bench/score/expected_pictures.h"
#include "bench/score/picture.h"

namespace wavecrest {

// exact: the hash is the committed one. tolerated: the hash is another build's or unknown, and the picture is within
// toleranceOf() the method. refused: another hash than this build's, or another picture. unknown: neither is committed.
enum class Validity { exact, tolerated, refused, unknown };
constexpr std::array<std::string_view, 4> kValidityNames{"exact", "within tolerance", "refused", "unknown"};

struct ImageVerdict {
  uint64_t hash = 0;
  Validity validity = Validity::unknown;
  std::optional<PictureDifference> difference;  // where pictures were compared
  std::string text;                             // kValidityNames, and the reason in brackets

  bool isAccepted() const { return validity == Validity::exact || validity == Validity::tolerated; }
};

struct ExpectedImages {
  ImageHashes hashes;
  ExpectedPictures pictures;
  static ExpectedImages committed() { return {ImageHashes::committed(), ExpectedPictures::committed()}; }
};

// film: after the entry's first slice (validatedImage of score.h), at the entry's size. build: the name of the build
// that rendered it.
ImageVerdict judgeImage(const Image& film, ScoreSize size, Isa isa, const ScoreEntry& entry,
                        const ExpectedImages& expected, const std::string& build = buildName());

}  // namespace wavecrest
