// The statistics of an image that is the sum of parts (merge.h), from those that the parts were rendered with.
//
// Counts and seconds are sums, sizes of memory the largest, rates and acceptances follow from the sums, notes are those
// of all parts, and what all parts have in common stays. There are no `snapshots`: those of a part show that part
// alone. Anything else is in `of_parts`, by its key with a value for each part: a number that is in none of the lists
// here does not get lost.
#pragma once

#include <nlohmann/json.hpp>
#include <span>

namespace wavecrest {

// parts: at least one, each as `render --stats` has it or as this function returned it. A single one comes back as it
// is. `iterations`, `relative_error` and `missing` of several follow from the films and are left to the caller. Throws
// nlohmann::json::exception where statistics are not as a render writes them.
nlohmann::ordered_json mergedStats(std::span<const nlohmann::ordered_json> parts);

}  // namespace wavecrest
