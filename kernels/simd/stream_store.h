// streamStore: writes a record of whole cache lines past the caches, so that a line which is written whole is not read
// from memory first. For records that go to many places and are not read again soon.
#pragma once

#include <emmintrin.h>  // SSE2, part of x86-64

#include <cstddef>
#include <cstring>
#include <type_traits>

namespace wavecrest {

// target: aligned to 64 bytes. Other threads may read it after streamFence() and a join.
template <class Record>
inline void streamStore(const Record& record, Record* target) {
  static_assert(std::is_trivially_copyable_v<Record> && sizeof(Record) % 64 == 0 && alignof(Record) % 64 == 0);
  __m128i words[sizeof(Record) / sizeof(__m128i)];
  std::memcpy(words, &record, sizeof(Record));
  auto* const out = reinterpret_cast<__m128i*>(target);
  for (size_t i = 0; i < sizeof(Record) / sizeof(__m128i); ++i) _mm_stream_si128(out + i, words[i]);
}

// Orders the streamed stores of this thread before what it does next.
inline void streamFence() { _mm_sfence(); }

}  // namespace wavecrest
