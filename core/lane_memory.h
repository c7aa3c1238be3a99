// Loads and stores where each lane has an address of its own.
#pragma once

#include <cstdint>
#include <cstring>

#include "core/lane_vec.h"
#include "core/lanes.h"

#if defined __AVX2__
#include <immintrin.h>
#endif

namespace alhazen {

/// Of the element of each lane's number, from a base that is common to them.
template <class I, class T>
[[nodiscard]] AddressOf<I> address_of(const T* base, const I& index) {
  static_assert(std::has_single_bit(sizeof(T)));
  const AddressOf<I> first(reinterpret_cast<uintptr_t>(base));
  return first + (convert<AddressOf<I>>(index) << std::countr_zero(sizeof(T)));
}

/// The number of 32 bits at each address, which need not be aligned.
template <class N>
[[nodiscard]] N load_at(const AddressOf<N>& addresses) {
  static_assert(sizeof(ScalarOf<N>) == 4);
#if defined __AVX512F__ && defined __GLIBCXX__
  if constexpr (kWidthOf<N> == 16) {
    const auto halves = std::experimental::split<std::experimental::native_simd<uint64_t>>(addresses);
    const __m256i low = _mm512_i64gather_epi32(static_cast<__m512i>(halves[0]), nullptr, 1);
    const __m256i high = _mm512_i64gather_epi32(static_cast<__m512i>(halves[1]), nullptr, 1);
    return std::bit_cast<N>(_mm512_inserti64x4(_mm512_castsi256_si512(low), high, 1));
  }
#elif defined __AVX2__ && defined __GLIBCXX__
  if constexpr (kWidthOf<N> == 8) {
    const auto halves = std::experimental::split<std::experimental::native_simd<uint64_t>>(addresses);
    const int* const base = nullptr;
    const __m128i low = _mm256_i64gather_epi32(base, static_cast<__m256i>(halves[0]), 1);
    const __m128i high = _mm256_i64gather_epi32(base, static_cast<__m256i>(halves[1]), 1);
    return std::bit_cast<N>(_mm256_set_m128i(high, low));
  }
#endif
  const auto load = [](uint64_t address) {
    ScalarOf<N> number;
    std::memcpy(&number, reinterpret_cast<const void*>(uintptr_t(address)), sizeof number);
    return number;
  };
  if constexpr (IsLanes<N>)
    return N([&](auto k) { return load(addresses[k]); });
  else
    return load(addresses);
}

/// The number of 64 bits at each address.
template <class F>
[[nodiscard]] AddressOf<F> load_words_at(const AddressOf<F>& addresses) {
#if defined __AVX512F__ && defined __GLIBCXX__
  if constexpr (kWidthOf<F> == 16) {
    using Half = std::experimental::native_simd<uint64_t>;
    const auto load = [](const Half& at) { return Half(_mm512_i64gather_epi64(static_cast<__m512i>(at), nullptr, 1)); };
    const auto halves = std::experimental::split<Half>(addresses);
    return std::experimental::concat(load(halves[0]), load(halves[1]));
  }
#elif defined __AVX2__ && defined __GLIBCXX__
  if constexpr (kWidthOf<F> == 8) {
    using Half = std::experimental::native_simd<uint64_t>;
    const auto load = [](const Half& at) {
      return Half(_mm256_i64gather_epi64(static_cast<const long long*>(nullptr), static_cast<__m256i>(at), 1));
    };
    const auto halves = std::experimental::split<Half>(addresses);
    return std::experimental::concat(load(halves[0]), load(halves[1]));
  }
#endif
  const auto load = [](uint64_t address) {
    uint64_t word;
    std::memcpy(&word, reinterpret_cast<const void*>(uintptr_t(address)), sizeof word);
    return word;
  };
  if constexpr (IsLanes<F>)
    return AddressOf<F>([&](auto k) { return load(addresses[k]); });
  else
    return load(addresses);
}

/// The three numbers of 32 bits from each address on. A load for each lane and a transposition take a quarter of the
/// time of gathers.
template <class N>
[[nodiscard]] std::array<N, 3> load_triples_at(const AddressOf<N>& addresses) {
#if defined __AVX512F__ && defined __AVX512VL__ && defined __GLIBCXX__
  if constexpr (kWidthOf<N> == 16) {
    LaneArray<AddressOf<N>> at;
    at.store(addresses);
    const auto triple = [&](size_t k) { return _mm_maskz_loadu_epi32(0b111, reinterpret_cast<const void*>(at[k])); };
    const auto every_fourth = [&](size_t k) {
      const __m512i first = _mm512_inserti32x4(_mm512_castsi128_si512(triple(k)), triple(k + 4), 1);
      return _mm512_inserti32x4(_mm512_inserti32x4(first, triple(k + 8), 2), triple(k + 12), 3);
    };
    const __m512i a = every_fourth(0), b = every_fourth(1), c = every_fourth(2), d = every_fourth(3);
    const __m512i ab = _mm512_unpacklo_epi32(a, b), cd = _mm512_unpacklo_epi32(c, d);  // x and y
    return {std::bit_cast<N>(_mm512_unpacklo_epi64(ab, cd)), std::bit_cast<N>(_mm512_unpackhi_epi64(ab, cd)),
            std::bit_cast<N>(_mm512_unpacklo_epi64(_mm512_unpackhi_epi32(a, b), _mm512_unpackhi_epi32(c, d)))};
  }
#endif
  return {load_at<N>(addresses), load_at<N>(addresses + AddressOf<N>(4)), load_at<N>(addresses + AddressOf<N>(8))};
}

/// Three numbers of 32 bits to each of the first `count` lanes' addresses on, by a transposition and a store for each.
template <class N>
void store_triples_at(const AddressOf<N>& addresses, const std::array<N, 3>& triples, size_t count) {
  LaneArray<AddressOf<N>> at;
  at.store(addresses);
#if defined __AVX512F__ && defined __AVX512VL__ && defined __GLIBCXX__
  if constexpr (kWidthOf<N> == 16) {
    if (count == 16) {
      const auto store_four = [&](size_t first, __m512i numbers) {
        const auto store = [&](size_t k, __m128i triple) {
          _mm_mask_storeu_epi32(reinterpret_cast<void*>(uintptr_t(at[k])), 0b111, triple);
        };
        store(first, _mm512_castsi512_si128(numbers)), store(first + 4, _mm512_extracti32x4_epi32(numbers, 1));
        store(first + 8, _mm512_extracti32x4_epi32(numbers, 2)),
            store(first + 12, _mm512_extracti32x4_epi32(numbers, 3));
      };
      const auto x = std::bit_cast<__m512i>(triples[0]), y = std::bit_cast<__m512i>(triples[1]),
                 z = std::bit_cast<__m512i>(triples[2]);
      const __m512i xy_low = _mm512_unpacklo_epi32(x, y), xy_high = _mm512_unpackhi_epi32(x, y),
                    z_low = _mm512_unpacklo_epi32(z, z), z_high = _mm512_unpackhi_epi32(z, z);
      store_four(0, _mm512_unpacklo_epi64(xy_low, z_low)), store_four(1, _mm512_unpackhi_epi64(xy_low, z_low));
      store_four(2, _mm512_unpacklo_epi64(xy_high, z_high)), store_four(3, _mm512_unpackhi_epi64(xy_high, z_high));
      return;
    }
  }
#endif
  std::array<LaneArray<N>, 3> numbers;
  for (size_t i = 0; i < 3; ++i) numbers[i].store(triples[i]);
  for (size_t k = 0; k < count; ++k) {
    const std::array<ScalarOf<N>, 3> triple{numbers[0][k], numbers[1][k], numbers[2][k]};
    std::memcpy(reinterpret_cast<void*>(uintptr_t(at[k])), triple.data(), sizeof triple);
  }
}

/// table[index] in each lane.
template <class N>
[[nodiscard]] N gather(const ScalarOf<N>* table, const IntOf<N>& index) {
  static_assert(sizeof(ScalarOf<N>) == 4);
#if defined __AVX512F__ && defined __GLIBCXX__
  if constexpr (kWidthOf<N> == 16)
    return std::bit_cast<N>(_mm512_i32gather_epi32(std::bit_cast<__m512i>(index), table, 4));
#elif defined __AVX2__ && defined __GLIBCXX__
  if constexpr (kWidthOf<N> == 8)
    return std::bit_cast<N>(
        _mm256_i32gather_epi32(reinterpret_cast<const int*>(table), std::bit_cast<__m256i>(index), 4));
#endif
  return load_at<N>(address_of(table, index));
}

/// The 64 bits that begin that many bytes, below 2^31, behind a place.
template <class F>
[[nodiscard]] AddressOf<F> load_words(const uint8_t* base, const IntOf<F>& offset) {
#if defined __AVX512F__ && defined __GLIBCXX__
  if constexpr (kWidthOf<F> == 16) {
    using Half = std::experimental::native_simd<uint64_t>;
    const auto load = [&](const __m256i& at) { return Half(_mm512_i32gather_epi64(at, base, 1)); };
    const auto offsets = std::bit_cast<__m512i>(offset);
    return std::experimental::concat(load(_mm512_castsi512_si256(offsets)),
                                     load(_mm512_extracti64x4_epi64(offsets, 1)));
  }
#endif
  return load_words_at<F>(address_of(base, offset));
}

/// table[byte] in each lane, of bytes in the lowest bits. Permutations of registers take half of the time of a gather.
template <class F>
[[nodiscard]] F entry_of_byte(const std::array<float, 256>& table, const IntOf<F>& byte) {
#if defined __AVX512F__ && defined __GLIBCXX__
  if constexpr (kWidthOf<F> == 16) {
    const auto index = std::bit_cast<__m512i>(byte);
    __m512 found[8];  // by the highest three bits
    for (size_t k = 0; k < 8; ++k)
      found[k] = _mm512_permutex2var_ps(_mm512_loadu_ps(&table[32 * k]), index, _mm512_loadu_ps(&table[32 * k + 16]));
    const auto choose = [&](size_t n, int bit) {
      const __mmask16 upper = _mm512_test_epi32_mask(index, _mm512_set1_epi32(bit));
      for (size_t k = 0; k < n; ++k) found[k] = _mm512_mask_blend_ps(upper, found[2 * k], found[2 * k + 1]);
    };
    choose(4, 32), choose(2, 64), choose(1, 128);
    return std::bit_cast<F>(found[0]);
  }
#endif
  return gather<F>(table.data(), byte);
}

/// Elements of several arrays at the same numbers, which may repeat. Where they lie close together, as neighbours in a
/// wave mostly do, two loads and a permutation stand for a gather.
template <class F>
class LanePicker {
 public:
  /// `first` and `last`: the least and the largest of the numbers.
  LanePicker(const IntOf<F>& numbers, uint32_t first, uint32_t last)
      : numbers_(numbers),
        low_(first / kWidth * kWidth),
        high_(last < low_ + kWidth ? low_ : low_ + kWidth),
        is_close_(last - low_ < 2 * kWidth) {}

  template <class N>
  [[nodiscard]] N pick(const Lanes<ScalarOf<N>>& from) const {
    static_assert(sizeof(ScalarOf<N>) == 4 && kWidthOf<N> == kWidth);
#if defined __AVX512F__ && defined __GLIBCXX__
    if constexpr (kWidth == 16) {
      // Arrays are readable up to a multiple of a register, and permutations look at the lowest bits of the numbers.
      static_assert(kWidth == kMaxLanes);
      if (is_close_)
        return std::bit_cast<N>(_mm512_permutex2var_epi32(_mm512_loadu_si512(from.data() + low_),
                                                          std::bit_cast<__m512i>(numbers_ - IntOf<F>(int32_t(low_))),
                                                          _mm512_loadu_si512(from.data() + high_)));
    }
#endif
    return gather<N>(from.data(), numbers_);
  }

 private:
  static constexpr uint32_t kWidth = uint32_t(kWidthOf<F>);

  IntOf<F> numbers_;
  uint32_t low_, high_;
  bool is_close_;
};

}  // namespace alhazen
