#include "engine/state/state_stream.h"

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

void StateReader::finish() const {
  if (!left_.empty()) throw StateError("its state goes on after its end");
}

}  // namespace wavecrest
