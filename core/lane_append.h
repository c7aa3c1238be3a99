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

/// Values of several lists of `n` lanes, appended to row after row in one order: lane after lane, in each that of the
/// first list, the second and so on, where the list's bit is set.
template <size_t n, size_t lists>
class LaneMerger {
 public:
  /// The bits of each list: one by one, as a copy of an array that was just filled waits for its memory.
  template <class... Bits>
  explicit LaneMerger(Bits... lanes) : lanes_{lanes...} {
    static_assert(sizeof...(Bits) == lists);
    for (size_t i = 0; i < lists; ++i) {
      size_ += size_t(std::popcount(lanes_[i]));
      if (lanes_[i] != 0) some_[count_++] = i;
    }
#if defined __AVX512F__ && defined __BMI2__
    const uint32_t a = lanes_[some_[0]], b = count_ == 2 ? lanes_[some_[1]] : 0;
    pairs_ = _pdep_u32(a, 0x55555555u) | _pdep_u32(b, 0xAAAAAAAAu);
#endif
  }

  [[nodiscard]] size_t size() const { return size_; }

  template <class T>
  void append(Lanes<T>& to, const std::array<const std::array<T, n>*, lists>& values) const {
    if (count_ == 1) return append_lanes(to, lanes_[some_[0]], *values[some_[0]]);
#if defined __AVX512F__ && defined __BMI2__
    if constexpr (n == 16)
      if (count_ == 2) return append_pairs(to, *values[some_[0]], *values[some_[1]]);
#endif
    for (size_t k = 0; k < n; ++k)
      for (size_t i = 0; i < count_; ++i)
        if (lanes_[some_[i]] >> k & 1) to.push((*values[some_[i]])[k]);
  }

  /// One value for all.
  template <class T>
  void append_same(Lanes<T>& to, const T& value) const {
    const size_t at = to.size();
    to.resize(at + size_);
    std::fill_n(&to[at], size_, value);
  }

 private:
#if defined __AVX512F__ && defined __BMI2__
  template <class T>
  void append_pairs(Lanes<T>& to, const std::array<T, n>& first, const std::array<T, n>& second) const {
    const __m512i low = _mm512_setr_epi32(0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23),
                  high = _mm512_add_epi32(low, _mm512_set1_epi32(8)), a = _mm512_loadu_si512(first.data()),
                  b = _mm512_loadu_si512(second.data());
    const size_t at = to.size(), middle = at + size_t(std::popcount(pairs_ & 0xFFFF));
    to.resize(at + 2 * n);
    const auto store = [&](size_t place, uint32_t lanes, const __m512i& order) {
      const __m512i pairs = _mm512_permutex2var_epi32(a, order, b);
      _mm512_storeu_si512(&to[place], _mm512_maskz_compress_epi32(__mmask16(lanes), pairs));
    };
    store(at, pairs_ & 0xFFFF, low), store(middle, pairs_ >> 16, high);
    to.resize(at + size_);
  }

  uint32_t pairs_ = 0;  // bit 2 k + i: lane k of list i, of two lists
#endif

  std::array<uint32_t, lists> lanes_;
  std::array<size_t, lists> some_{};  // of the lists, those that are not empty
  size_t count_ = 0, size_ = 0;
};

}  // namespace alhazen
