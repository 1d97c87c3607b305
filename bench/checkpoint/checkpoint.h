// Checkpoints: files from which a render goes on bit for bit, in another process and with any number of threads.
//
//   "wavecrest checkpoint 1\n"   the format
//   uint64                       bytes of the header
//   header                       JSON: `scene`, its name; `render`, everything that decides the image's bits
//                                (renderIdentity); `cut`, how light paths of merging methods are cut into waves;
//                                `notes`, the caller's own
//   state                        Session::save
//   uint32                       CRC-32 (zlib's) of all bytes before
//
// Numbers are little-endian. A file is replaced as a whole: whoever is killed while it is written leaves the last one.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

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

class Checkpoint {
 public:
  // Throws CheckpointError where the file is damaged or no checkpoint, ImageError where it cannot be read.
  explicit Checkpoint(const std::string& file);

  // Settings with which a session can go on: light paths are cut as they were. To be applied before it is made.
  void cutAlike(RenderSettings& settings) const;
  // Restores the session's state; it must be new. Throws CheckpointError with the first difference where scene or
  // settings are others than those of the checkpoint.
  void restore(const Scene& scene, const RenderSettings& settings, Session& session) const;
  const nlohmann::ordered_json& notes() const { return notes_; }

 private:
  [[noreturn]] void fail(const std::string& wrong, const std::string& expected) const;
  void requireSame(const nlohmann::ordered_json& wanted) const;

  std::string file_;
  std::vector<unsigned char> bytes_;
  std::span<const unsigned char> state_;  // within the bytes
  nlohmann::ordered_json render_, notes_;
  uint32_t threads_ = 0;  // for which its work is cut
};

}  // namespace wavecrest
