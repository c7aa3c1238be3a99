#include "core/lane_memory.h"
#include "materials/byte_tables.h"
#include "materials/texel_records.h"

namespace alhazen {
#if defined __AVX512F__ && defined __GLIBCXX__
namespace {

/// Records of single hits, a byte in each of 16 lanes.
class RecordMixer {
 public:
  RecordMixer(const TexelRecords& records, const LevelTexels<ShadingLanes>& at) : encoded_(__mmask16(records.encoded)) {
    using A = AddressOf<ShadingLanes>;
    const A first(reinterpret_cast<uintptr_t>(records.data.get())), size(records.size);
    const auto store = [&](size_t i, const A& row, const IntOf<ShadingLanes>& column) {
      records_[i].store(first + (row + convert<A>(column)) * size);
    };
    store(0, at.row.a, at.column.a), store(1, at.row.a, at.column.b);
    store(2, at.row.b, at.column.a), store(3, at.row.b, at.column.b);
    columns_.store(at.column.t), rows_.store(at.row.t);
  }

  /// What one lane's hit sees, as `filtered` would mix it byte by byte.
  [[nodiscard]] __m512 mixed(size_t lane) const {
    const float t = columns_[lane];
    return mix(in_row(records_[0][lane], records_[1][lane], t), in_row(records_[2][lane], records_[3][lane], t),
               rows_[lane]);
  }
  static __m512 mix(__m512 a, __m512 b, float t) {
    return _mm512_add_ps(_mm512_mul_ps(a, _mm512_set1_ps(1 - t)), _mm512_mul_ps(b, _mm512_set1_ps(t)));
  }

 private:
  /// The first halves of two neighbours, which may be encoded, are decoded together, and so are the others.
  [[nodiscard]] __m512 in_row(uint64_t left, uint64_t right, float t) const {
    const auto record = [](uint64_t at) { return _mm_loadu_si128(reinterpret_cast<const __m128i*>(uintptr_t(at))); };
    const __m128i a = record(left), b = record(right);
    const __m512i first = _mm512_cvtepu8_epi32(_mm_unpacklo_epi64(a, b)),
                  second = _mm512_cvtepu8_epi32(_mm_unpackhi_epi64(a, b));
    const auto weights = _mm512_mask_blend_ps(0xFF00, _mm512_set1_ps(1 - t), _mm512_set1_ps(t));
    const __m512 x = _mm512_mul_ps(decoded(first), weights), y = _mm512_mul_ps(linear(second), weights);
    return _mm512_add_ps(_mm512_shuffle_f32x4(x, y, _MM_SHUFFLE(1, 0, 1, 0)),
                         _mm512_shuffle_f32x4(x, y, _MM_SHUFFLE(3, 2, 3, 2)));
  }
  static __m512 linear(__m512i bytes) {
    return static_cast<__m512>(linear_byte(ShadingLanes(_mm512_cvtepi32_ps(bytes))));
  }
  [[nodiscard]] __m512 decoded(__m512i bytes) const {
    const auto of_byte = std::bit_cast<IntOf<ShadingLanes>>(bytes);
    const ShadingLanes light = entry_of_byte<ShadingLanes>(kLightOfByte[size_t(ColorSpace::srgb)], of_byte);
    return _mm512_mask_blend_ps(__mmask16(encoded_ | encoded_ << 8), linear(bytes), static_cast<__m512>(light));
  }

  __mmask16 encoded_;
  std::array<LaneArray<AddressOf<ShadingLanes>>, 4> records_;
  LaneArray<ShadingLanes> columns_, rows_;
};

}  // namespace

void mix_records(const TexelRecords& records, TextureLookup<ShadingLanes>& lookup) noexcept {
  const uint32_t between = lane_bits(lookup.fraction > ShadingLanes(0));
  const RecordMixer large(records, lookup.large), small(records, between ? lookup.small : lookup.large);
  LaneArray<ShadingLanes> fraction;
  fraction.store(lookup.fraction);
  for (size_t k = 0; k < kWidthOf<ShadingLanes>; ++k) {
    __m512 bytes = large.mixed(k);
    if (between >> k & 1) bytes = RecordMixer::mix(bytes, small.mixed(k), fraction[k]);
    _mm512_store_ps(lookup.mixed.bytes[k].values.data(), bytes);
  }
}
#else
void mix_records(const TexelRecords&, TextureLookup<ShadingLanes>&) noexcept {}
#endif

BasicRgba<ShadingLanes> part_of(const TextureLookup<ShadingLanes>::Mixed& mixed, const TextureImage& image) noexcept {
  using F = ShadingLanes;
  using A = AddressOf<F>;
  const A first(reinterpret_cast<uintptr_t>(mixed.bytes[0].values.data()) + image.first_byte * sizeof(float));
  const A at = first + A([](auto k) { return k * sizeof(mixed.bytes[0]); });
  const auto channel = [&](int c) { return load_at<F>(at + A(uint64_t(c) * sizeof(float))); };
  if (image.channels < 3) return {BasicRgb<F>(channel(0)), image.channels == 2 ? channel(1) : F(1)};
  const std::array<F, 3> rgb = load_triples_at<F>(at);
  return {{rgb[0], rgb[1], rgb[2]}, image.channels == 4 ? channel(3) : F(1)};
}

}  // namespace alhazen
