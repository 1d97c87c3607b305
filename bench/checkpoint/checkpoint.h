// Checkpoints: files from which a render goes on bit for bit, in another process and with any number of threads.
//
//   "wavecrest checkpoint 2\n"   the format
//   uint64                       bytes of the header
//   header                       JSON: `scene`, its name; `render`, everything that decides the image's bits
//                                (renderIdentity); `holds`, which share of the image (Holdings); `cut`, how light
//                                paths of merging methods are cut into waves; `notes`, the caller's own
//   state                        Session::save: the film, what was done, and what only the method's session reads
//   uint32                       CRC-32 (zlib's) of all bytes before
//
// Numbers are little-endian. A file is replaced as a whole: whoever is killed while it is written leaves the last one.
#pragma once

#include <array>
#include <functional>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "bench/checkpoint/holdings.h"
#include "engine/scene/scene.h"
#include "engine/session/session.h"

namespace wavecrest {

// A checkpoint that cannot be used: damaged, or of another render. The text is complete.
struct CheckpointError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// The program, scene, film and settings on which the bits of an image depend, in words of stats and options. Threads,
// time and number of iterations are not among them.
nlohmann::ordered_json renderIdentity(const Scene& scene, const RenderSettings& settings, const Session& session);

// settings: those the session was made with. notes: come back from the checkpoint as they are. Throws ImageError where
// the file cannot be written.
void writeCheckpoint(const std::string& file, const Scene& scene, const RenderSettings& settings,
                     const Session& session, const nlohmann::ordered_json& notes);

// What a checkpoint says of itself.
struct CheckpointHeader {
  std::string scene;
  nlohmann::ordered_json render, cut, notes;
  Holdings holds;
};

// The header alone, without the checksum of what follows. Throws as Checkpoint does.
CheckpointHeader readCheckpointHeader(const std::string& file);

// Replaces the file by a checkpoint with this header. save writes the state.
void writeCheckpoint(const std::string& file, const CheckpointHeader& header,
                     const std::function<void(StateWriter&)>& save);

// Throws CheckpointError: FILE: WRONG; EXPECTED.
[[noreturn]] void failCheckpoint(const std::string& file, const std::string& wrong, const std::string& expected);
constexpr const char* kSameRender = "expected the scene and settings that it was made with, or another file";
// Throws with the first difference of what a checkpoint was made of, in the order of renderIdentity: the method before
// its settings, the size before the hash. Keys in `except` may differ. expected: the end of the message.
void requireSameRender(const std::string& file, const nlohmann::ordered_json& found,
                       const nlohmann::ordered_json& wanted, std::span<const std::string_view> except = {},
                       const std::string& expected = kSameRender);
// What says which share of the image a render is of; the rest of its identity is common to all.
constexpr std::array<std::string_view, 3> kShareKeys{"first_iteration", "process", "part"};
// What is expected of a file that is damaged.
constexpr const char* kIntactCheckpoint = "expected one as `render --checkpoint` or `merge --checkpoint` left it";

class Checkpoint {
 public:
  // Throws CheckpointError where the file is damaged or no checkpoint, ImageError where it cannot be read.
  explicit Checkpoint(const std::string& file);

  // Settings with which a session can go on: light paths are cut as they were, and a budget of memory allows no more of
  // them. To be applied before it is made.
  void cutAlike(RenderSettings& settings) const;
  // Restores the session's state; it must be new. Throws CheckpointError with the first difference where scene or
  // settings are others than those of the checkpoint.
  void restore(const Scene& scene, const RenderSettings& settings, Session& session) const;
  const CheckpointHeader& header() const { return header_; }
  std::span<const unsigned char> state() const { return state_; }

 private:
  std::string file_;
  std::vector<unsigned char> bytes_;
  std::span<const unsigned char> state_;  // within the bytes
  CheckpointHeader header_;
};

}  // namespace wavecrest
