// Growable arrays for waves: aligned for vector loads, and never given back between waves.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <type_traits>

namespace alhazen {

inline constexpr size_t kLaneAlignment = 64;  // bytes: one AVX-512 register, one cache line
inline constexpr size_t kMaxLanes = 16;  // the widest packet; arrays are readable and writable up to a multiple of it

/// An array of plain values that keeps its memory when it shrinks, so that steady use does not allocate.
template <class T>
class Lanes {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  [[nodiscard]] size_t size() const { return size_; }
  [[nodiscard]] T* data() { return data_.get(); }
  [[nodiscard]] const T* data() const { return data_.get(); }
  T& operator[](size_t i) { return data_[i]; }
  const T& operator[](size_t i) const { return data_[i]; }

  /// Keeps the first min(old, new) values; the others are not initialised.
  void resize(size_t size) {
    if (size > capacity_) grow(size);
    size_ = size;
  }

  void push(const T& value) { *append_unset(1, 1) = value; }

  /// Makes room for `count` more values, which are not set; up to `writable` can be written there.
  T* append_unset(size_t count, size_t writable) {
    const size_t at = size_;
    if (at + writable > capacity_) grow(at + writable);
    size_ = at + count;
    return &data_[at];
  }

  /// The other's values from `first` on.
  void append(const Lanes& other, size_t first = 0) {
    const size_t count = other.size_ - first;
    if (count) std::memcpy(append_unset(count, count), &other.data_[first], count * sizeof(T));
  }

 private:
  struct Free {
    void operator()(T* p) const { std::free(p); }
  };

  /// Rare, and not to be repeated wherever something is appended.
  [[gnu::noinline, gnu::cold]] void grow(size_t size) {
    const size_t wanted = size > 2 * capacity_ ? size : 2 * capacity_;
    const size_t padded = (wanted + kMaxLanes - 1) / kMaxLanes * kMaxLanes;
    const size_t bytes = (padded * sizeof(T) + kLaneAlignment - 1) / kLaneAlignment * kLaneAlignment;
    std::unique_ptr<T[], Free> bigger(static_cast<T*>(std::aligned_alloc(kLaneAlignment, bytes)));
    if (!bigger) throw std::bad_alloc();
    // Zeros, so that the padding lanes of a packet never hold signalling garbage.
    std::memset(static_cast<void*>(bigger.get()), 0, bytes);
    if (size_) std::memcpy(static_cast<void*>(bigger.get()), data_.get(), size_ * sizeof(T));
    data_ = std::move(bigger);
    capacity_ = padded;
  }

  std::unique_ptr<T[], Free> data_;
  size_t size_ = 0, capacity_ = 0;
};

}  // namespace alhazen
