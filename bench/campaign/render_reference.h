// Renders a scene's reference: two independent halves of equal iterations, side by side, until good enough.
//
// The file is written every now and then and at the end, whole, so whatever ends the process leaves a reference that
// the next call continues: sample sequences and merge radii go on where they were, and no random number comes twice.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>

#include "bench/campaign/reference_file.h"
#include "bench/campaign/session_hooks.h"
#include "engine/session/session.h"

namespace wavecrest {

// The first radius of merging methods, relative to the scene's: it shrinks to a third within 10^4 iterations, and bias
// goes with its square. With a tenth of it single bright pixels, of paths that nearly only merging makes, stay for
// hours, an error a thousand times that of blurring.
constexpr double kReferenceRadius = 1e-3;

// Counted from the beginning of the reference, over all calls that worked on it; the first that is reached counts. An
// error counts after a few iterations, and never of a black image: one that is black after kBlackIterations
// (bench/until/film_error.h) ends a render that has no other goal.
struct ReferenceGoal {
  std::optional<double> relativeError;
  std::optional<double> seconds;       // of render time, both halves together
  std::optional<uint64_t> iterations;  // of each half
};

struct ReferenceHooks {
  SessionHooks session;
  std::function<bool()> stopped;                      // true: save and return
  std::function<bool()> saveNow;                      // true: save and go on; asked after every few iterations
  std::function<void(const ReferenceInfo&)> advance;  // after every few iterations
};

// The file holds another reference than the one asked for. The text is complete.
struct ReferenceMismatch : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// The seed of a half: unlike that of any other render, because campaigns and users count from 0 and seldom reach 2^32.
// A continuation has it too, and begins at a later iteration: it adds what an unbroken render would have added.
uint64_t referenceSeed(uint64_t seed, size_t half);

// Writes the first state of a reference: a larger one of the same scene, averaged down to its film (shrunkReference).
// renderReference goes on with it. Throws ReferenceMismatch where the file exists, where the larger one cannot be
// shrunk or was rendered with other settings; FileLockError; ImageError.
void beginReference(const Scene& scene, const RenderSettings& settings, const std::filesystem::path& larger,
                    const std::filesystem::path& file);

// settings.seed is the seed of both halves, which differ in its high word. Renders nothing if the file has reached the
// goal. Throws ReferenceMismatch, FileLockError where another process works on it, ImageError, and what Session::create
// throws.
Reference renderReference(const Scene& scene, const RenderSettings& settings, const std::string& methodReason,
                          const ReferenceGoal& goal, const std::filesystem::path& file, const ReferenceHooks& hooks);

}  // namespace wavecrest
