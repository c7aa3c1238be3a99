// What some of the lanes hold, appended to rows.
#pragma once

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
  const size_t at = to.size();
  to.resize(at + n);
#if defined __AVX512F__
  if constexpr (n == 16) {
    const __m512i packed = _mm512_maskz_compress_epi32(__mmask16(lanes), _mm512_loadu_si512(values.data()));
    _mm512_storeu_si512(&to[at], packed);
    return to.resize(at + size_t(std::popcount(lanes)));
  }
#endif
  size_t end = at;
  for (; lanes; lanes &= lanes - 1) to[end++] = values[size_t(std::countr_zero(lanes))];
  to.resize(end);
}

/// Values of a block's lanes, and the lanes that count.
template <class T, size_t n>
struct ChosenLanes {
  uint32_t lanes;
  const std::array<T, n>* values;
};

namespace lane_detail {

template <class T, size_t n>
void append_pairs(Lanes<T>& to, const ChosenLanes<T, n>& first, const ChosenLanes<T, n>& second) {
#if defined __AVX512F__ && defined __BMI2__
  if constexpr (n == 16) {
    const __m512i low = _mm512_setr_epi32(0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23),
                  a = _mm512_loadu_si512(first.values->data()), b = _mm512_loadu_si512(second.values->data());
    const uint32_t lanes = _pdep_u32(first.lanes, 0x55555555u) | _pdep_u32(second.lanes, 0xAAAAAAAAu);
    const auto append = [&](const __m512i& pairs, uint32_t bits) {
      append_lanes(to, bits, std::bit_cast<std::array<T, n>>(pairs));
    };
    append(_mm512_permutex2var_epi32(a, low, b), lanes & 0xFFFF);
    return append(_mm512_permutex2var_epi32(a, _mm512_add_epi32(low, _mm512_set1_epi32(8)), b), lanes >> 16);
  }
#endif
  for (size_t k = 0; k < n; ++k) {
    if (first.lanes >> k & 1) to.push((*first.values)[k]);
    if (second.lanes >> k & 1) to.push((*second.values)[k]);
  }
}

}  // namespace lane_detail

/// Appends, lane after lane, the values of those that count there, in the order of the list.
template <class T, size_t n, size_t lists>
void append_in_turn(Lanes<T>& to, const std::array<ChosenLanes<T, n>, lists>& from) {
  std::array<const ChosenLanes<T, n>*, lists> some;
  size_t count = 0;
  for (const ChosenLanes<T, n>& chosen : from)
    if (chosen.lanes != 0) some[count++] = &chosen;
  if (count == 0) return;
  if (count == 1) return append_lanes(to, some[0]->lanes, *some[0]->values);
  if (count == 2) return lane_detail::append_pairs(to, *some[0], *some[1]);
  for (size_t k = 0; k < n; ++k)
    for (size_t i = 0; i < count; ++i)
      if (some[i]->lanes >> k & 1) to.push((*some[i]->values)[k]);
}

}  // namespace alhazen
