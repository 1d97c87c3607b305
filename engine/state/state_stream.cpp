#include "engine/state/state_stream.h"

#include <string>

namespace wavecrest {

void StateWriter::bytes(std::span<const unsigned char> bytes) {
  if (waiting_.size() + bytes.size() > kBlock) flush();
  if (bytes.size() > kBlock) {
    sink_(bytes);
    return;
  }
  waiting_.insert(waiting_.end(), bytes.begin(), bytes.end());
}

void StateWriter::flush() {
  if (!waiting_.empty()) sink_(waiting_);
  waiting_.clear();
}

void StateReader::expect(uint64_t expected, const char* what) {
  const auto found = value<uint64_t>();
  if (found == expected) return;
  throw StateError("it has " + std::to_string(found) + " " + what + ", this render " + std::to_string(expected));
}

void StateReader::finish() const {
  if (!left_.empty()) throw StateError("its state goes on after its end");
}

}  // namespace wavecrest
