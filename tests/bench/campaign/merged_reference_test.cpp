// What a reference out of the parts of one render says of how it was made.
#include "bench/campaign/merged_reference.h"

#include <gtest/gtest.h>

namespace wavecrest {
namespace {

constexpr uint32_t kSide = 8;

// Parts of a render of a method, with grey halves.
MergedParts partsBy(const char* method) {
  MergedParts parts;
  parts.film = std::make_unique<Film>(FilmArea::make(0, 0, kSide, kSide));
  parts.halves = {std::vector<float>(3 * kSide * kSide, 0.4F), std::vector<float>(3 * kSide * kSide, 0.6F)};
  parts.header.scene = "box";
  parts.header.render = {
      {"method", method}, {"scene_hash", "00ff"}, {"sampler", "independent"}, {"precision", "float"}, {"seed", 3},
      {"max_depth", 5},   {"rr_depth", 5},        {"version", "0.1"},         {"commit", "abc"}};
  parts.header.notes = {{"stats", {{"iterations", 8}}}};
  return parts;
}

TEST(MergedReference, isNamedAfterItsMethod) {
  const ReferenceInfo info = mergedReference(partsBy("bpt")).info;
  EXPECT_EQ(info.method, "bpt");
  EXPECT_EQ(info.methodReason, "parts of one render");
  EXPECT_EQ(info.iterations, 4u) << "of each half";
}

TEST(MergedReference, ofAChoiceIsNamedAfterTheMethodThatRenderedIt) {
  MergedParts parts = partsBy("evcm");
  parts.header.render.update({{"chosen", "vcm"}, {"radius", 0.001}, {"radius_alpha", 0.75}});
  const ReferenceInfo info = mergedReference(parts).info;
  EXPECT_EQ(info.method, "vcm");
  EXPECT_EQ(info.methodReason, "parts of one render, chosen by the trials of evcm");
  EXPECT_TRUE(info.isBiased());
}

}  // namespace
}  // namespace wavecrest
