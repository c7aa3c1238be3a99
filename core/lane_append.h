// What some of the lanes hold, appended to rows.
#pragma once

#include <algorithm>
#include <array>
#include <bit>

#include "core/lanes.h"

#if defined __AVX512F__
#include <immintrin.h>
#endif

namespace alhazen {

/// Appends the values whose bit is set, in their order.
template <class T, size_t n>
void append_lanes(Lanes<T>& to, uint32_t lanes, const std::array<T, n>& values) {
  static_assert(sizeof(T) == 4);
  T* next = to.append_unset(size_t(std::popcount(lanes)), n);
#if defined __AVX512F__
  if constexpr (n == 16) {
    const __m512i packed = _mm512_maskz_compress_epi32(__mmask16(lanes), _mm512_loadu_si512(values.data()));
    return _mm512_storeu_si512(next, packed);
  }
#endif
  for (; lanes; lanes &= lanes - 1) *next++ = values[size_t(std::countr_zero(lanes))];
}

/// Appends the value `count` times, at most `n`.
template <size_t n, class T>
void append_same(Lanes<T>& to, size_t count, const T& value) {
  std::fill_n(to.append_unset(count, n), n, value);
}

}  // namespace alhazen
