// Which share of an image a checkpoint holds, so that sums of checkpoints miss nothing and have nothing twice.
//
// Of most methods these are runs of iterations. Of mlt these are shares of the chains, in all iterations so far
// (RenderShare).
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/session/session.h"

namespace wavecrest {

struct Holdings {
  struct Run {
    uint64_t begin = 0, end = 0;  // iterations [begin, end)
    bool operator==(const Run&) const = default;
  };
  struct ChainShare {
    uint32_t part = 0, parts = 1;  // chains whose number is `part` modulo `parts`
    uint64_t iterations = 0;
    bool operator==(const ChainShare&) const = default;
  };

  std::vector<Run> runs;           // ascending, neighbours joined; empty of mlt
  std::vector<ChainShare> chains;  // of mlt
  uint64_t lacking = 0;            // samples that pixels lack in these runs, where a render stopped within an iteration
  uint64_t of = 0;                 // iterations of the whole image, 0 where that is not known
  uint32_t parts = 1;              // that the whole image was cut into
  bool sum = false;                // of several checkpoints

  // Whether a session can go on from it.
  bool goesOn() const { return !sum || (chains.empty() && lacking == 0 && runs.size() == 1); }
  bool operator==(const Holdings&) const = default;

  // What both hold, in words; empty: nothing.
  std::string overlap(const Holdings& other) const;
  // Takes in what another checkpoint of the same render holds; both must not overlap.
  void add(const Holdings& other);
  // What is missing of the whole image, in words; empty: nothing. allChains: of the render, of mlt.
  std::string missing(uint64_t allChains) const;
};

Holdings holdingsOf(const RenderSettings& settings, const Session& session);

nlohmann::ordered_json toJson(const Holdings& holdings);
// Throws nlohmann::json::exception.
Holdings holdingsFrom(const nlohmann::ordered_json& json);

}  // namespace wavecrest
