// The state of a session as bytes, in the order in which it is written and read: what checkpoints hold.
//
// A state belongs to a render, not to a process: it does not depend on the number of threads or the size of waves, and
// a session that is cut otherwise goes on from it. Numbers are stored as the machine has them (all instruction sets
// are x86-64). Whoever stores the bytes makes sure that they come back undamaged (bench/checkpoint does); a reader
// throws where they end too early or belong to a render of another shape, and never reads past their end.
#pragma once

#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <vector>

namespace wavecrest {

// Bytes that are not the state of such a session.
struct StateError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class StateWriter {
 public:
  using Sink = std::function<void(std::span<const unsigned char>)>;
  // The sink takes the bytes in blocks, the last of them in flush().
  explicit StateWriter(Sink sink) : sink_(std::move(sink)) { waiting_.reserve(kBlock); }

  // T without padding between or behind its members.
  template <class T>
  void items(const T* values, size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes({reinterpret_cast<const unsigned char*>(values), count * sizeof(T)});
  }
  template <class T>
  void value(const T& value) {
    items(&value, 1);
  }
  // With its length.
  template <class T>
  void list(const std::vector<T>& values) {
    value(uint64_t{values.size()});
    items(values.data(), values.size());
  }
  void bytes(std::span<const unsigned char> bytes);
  void flush();

 private:
  static constexpr size_t kBlock = 1 << 20;
  Sink sink_;
  std::vector<unsigned char> waiting_;
};

class StateReader {
 public:
  explicit StateReader(std::span<const unsigned char> bytes) : left_(bytes) {}

  template <class T>
  void items(T* values, size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (count > left_.size() / sizeof(T)) throw StateError("its state ends too early");
    if (count != 0) std::memcpy(values, left_.data(), count * sizeof(T));
    left_ = left_.subspan(count * sizeof(T));
  }
  template <class T>
  T value() {
    T value;
    items(&value, 1);
    return value;
  }
  template <class T>
  std::vector<T> list() {
    const auto count = value<uint64_t>();
    if (count > left_.size() / sizeof(T)) throw StateError("its state ends too early");
    std::vector<T> values(count);
    items(values.data(), count);
    return values;
  }
  // Adds as many values as there are in `sums`, which may not be aligned here, to them.
  template <class T>
  void addTo(std::span<T> sums) {
    if (sums.size() > left_.size() / sizeof(T)) throw StateError("its state ends too early");
    for (size_t i = 0; i < sums.size(); ++i) {
      T value;
      std::memcpy(&value, left_.data() + i * sizeof(T), sizeof(T));
      sums[i] += value;
    }
    left_ = left_.subspan(sums.size() * sizeof(T));
  }
  // Bytes that are left.
  size_t left() const { return left_.size(); }
  // Nothing may be left.
  void finish() const;

 private:
  std::span<const unsigned char> left_;
};

// What save(StateWriter&) writes, behind `head` bytes of 0. about: how many bytes there will be.
template <class Save>
std::vector<unsigned char> savedBytes(const Save& save, size_t head = 0, size_t about = 0) {
  std::vector<unsigned char> bytes(head);
  bytes.reserve(head + about);
  StateWriter out([&](std::span<const unsigned char> block) { bytes.insert(bytes.end(), block.begin(), block.end()); });
  save(out);
  out.flush();
  return bytes;
}

}  // namespace wavecrest
